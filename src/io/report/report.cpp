#include <umov/io/report.h>

#include "io/report/assemble.h"
#include "io/report/page.h"
#include "io/report/report_data.h"

#include <algorithm>
#include <cmath>
#include <umov/core/embedded.h>

UMOV_EMBEDDED(report_template)
UMOV_EMBEDDED(report_css)
UMOV_EMBEDDED(report_js_model)
UMOV_EMBEDDED(report_js_plot)
UMOV_EMBEDDED(report_js_time)
UMOV_EMBEDDED(report_js_plane)
UMOV_EMBEDDED(report_js_turning)
UMOV_EMBEDDED(report_js_boxes)
UMOV_EMBEDDED(report_js_main)

namespace umov {
namespace {

std::string html_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
    case '&':
      out += "&amp;";
      break;
    case '<':
      out += "&lt;";
      break;
    case '>':
      out += "&gt;";
      break;
    case '"':
      out += "&quot;";
      break;
    case '\'':
      out += "&#39;";
      break;
    default:
      out += c;
    }
  }
  return out;
}

std::string page_script() {
  std::string out = "(() => {\n\"use strict\";\n";
  for (const std::string_view part :
       {report_js_model(), report_js_plot(), report_js_time(), report_js_plane(),
        report_js_turning(), report_js_boxes(), report_js_main()})
    out += part;
  return out + "})();\n";
}

} // namespace

Result<std::string> assemble_report(const ReportInput &input, std::string_view plotting_script) {
  if (plotting_script.empty())
    return fail(ErrorCode::Internal,
                "this build has no plotting script, so it cannot write report.html. Install the "
                "Python package plotly (pip install plotly) and configure again with "
                "-DUMOV_PLOTLY_JS=.../plotly/package_data/plotly.min.js, or leave \"html\" out of "
                "[output] formats.");
  UMOV_ASSIGN(data, report_data(input));
  const PageSlot slots[] = {
      {"TITLE", html_text(input.title)},
      {"CSS", std::string(report_css())},
      {"DATA", std::move(data)},
      {"PLOTLY", std::string(plotting_script)},
      {"PLOTLY_LICENCE", html_text(report_plotly_licence())},
      {"SCRIPT", page_script()},
  };
  return fill_page(report_template(), slots);
}

bool has_report() { return !report_plotly().empty(); }

Result<std::string> make_report(const ReportInput &input) {
  return assemble_report(input, report_plotly());
}

std::vector<PureMaterialCurve> pure_material_curves(std::span<const Surface> surfaces,
                                                    const BandGrid &grid) {
  std::vector<PureMaterialCurve> out;
  for (const Surface &surface : surfaces) {
    const std::string &name = surface.material().name;
    if (std::any_of(out.begin(), out.end(), [&](const auto &c) { return c.material == name; }))
      continue;
    for (std::size_t band = 0; band < grid.terms().size(); ++band) {
      PureMaterialCurve curve{name, band, {}, {}};
      for (int deg = 0; deg <= 180; ++deg) {
        const double l_v = std::cos(deg * (pi / 180));
        const auto light =
            sum_band<Stokes<ScatteringPlane>>(grid.terms()[band], [&](std::size_t node) {
              const FresnelFactors f = surface.fresnel(node, l_v);
              return Stokes<ScatteringPlane>{f.a, f.b, 0, 0};
            }).value;
        if (!(light.i > 0)) // an interface that reflects nothing (n = 1) has no q
          continue;
        curve.phase_deg.push_back(deg);
        curve.q_scat.push_back(light.q / light.i);
      }
      if (!curve.phase_deg.empty())
        out.push_back(std::move(curve));
    }
  }
  return out;
}

} // namespace umov
