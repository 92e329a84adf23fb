#include <umov/io/plot_page.h>

#include "io/report/colours.h"
#include "io/report/plot_json.h"

#include <cmath>
#include <umov/core/embedded.h>
#include <umov/io/report.h>

UMOV_EMBEDDED(report_plotly)
UMOV_EMBEDDED(report_plotly_licence)
UMOV_EMBEDDED(plot_page_template)
UMOV_EMBEDDED(plot_page_figure_js)
UMOV_EMBEDDED(plot_page_js)

namespace umov {
namespace {

using Json = nlohmann::ordered_json;

Json numbers(const std::vector<double> &values) {
  Json out = Json::array();
  for (const double v : values)
    out.push_back(std::isfinite(v) ? Json(v) : Json(nullptr));
  return out;
}

} // namespace

Json figure_json(const PlotFigure &figure) {
  Json lines = Json::array();
  for (const PlotLine &line : figure.lines) {
    lines.push_back({{"name", line.name},
                     {"x", numbers(line.x)},
                     {"y", numbers(line.y)},
                     {"colour", plot_colour(line.colour)},
                     {"dash", line.dash},
                     {"markers", line.has_markers},
                     {"labels", line.labels}});
    if (!line.z.empty())
      lines.back()["z"] = numbers(line.z);
  }
  return {{"title", figure.title}, {"x", figure.x_title},     {"y", figure.y_title},
          {"z", figure.z_title},   {"log", figure.has_log_y}, {"sky", figure.is_sky},
          {"lines", lines}};
}

std::string inert_json(const Json &data) {
  std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (std::size_t at = text.find("</"); at != std::string::npos; at = text.find("</", at + 3))
    text.replace(at, 2, "<\\/");
  return text;
}

void fill_in(std::string &page, std::string_view mark, std::string_view text) {
  if (const std::size_t at = page.find(mark); at != std::string::npos)
    page.replace(at, mark.size(), text);
}

Result<std::string> make_plot_page(const std::string &title, const std::vector<PlotFigure> &figures,
                                   const std::vector<std::string> &notes) {
  if (!has_report())
    return fail(ErrorCode::Internal,
                "this build has no plotting script: run tools/setup and build again");
  Json data{{"title", title}, {"figures", Json::array()}, {"notes", notes}};
  for (const PlotFigure &figure : figures)
    data["figures"].push_back(figure_json(figure));
  std::string page(plot_page_template());
  fill_in(page, "{{data}}", inert_json(data));
  fill_in(page, "{{figure}}", plot_page_figure_js());
  fill_in(page, "{{script}}", plot_page_js());
  fill_in(page, "{{licence}}", report_plotly_licence());
  fill_in(page, "{{plotly}}", report_plotly());
  return page;
}

} // namespace umov
