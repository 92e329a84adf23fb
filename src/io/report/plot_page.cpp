#include <umov/io/plot_page.h>

#include "io/report/page.h"
#include "io/report/plot_json.h"
#include <umov/picture/colours.h>

#include <cmath>
#include <umov/core/embedded.h>

UMOV_EMBEDDED(plot_page_template)
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

Json span_json(const std::array<double, 2> &span) {
  return span[0] == span[1] ? Json(nullptr) : Json(span);
}

} // namespace

const char *plot_dash(std::size_t number) {
  constexpr const char *dashes[] = {"solid", "dash", "dot", "dashdot"};
  return dashes[number % std::size(dashes)];
}

Json figure_json(const PlotFigure &figure) {
  Json lines = Json::array();
  for (const PlotLine &line : figure.lines) {
    lines.push_back({{"name", line.name},
                     {"x", numbers(line.x)},
                     {"y", numbers(line.y)},
                     {"colour", plot_colour(line.colour)},
                     {"dash", line.dash},
                     {"markers", line.has_markers},
                     {"labels", line.labels},
                     {"faint", line.is_faint}});
    if (!line.z.empty())
      lines.back()["z"] = numbers(line.z);
  }
  Json out{{"title", figure.title},
           {"x", figure.x_title},
           {"y", figure.y_title},
           {"z", figure.z_title},
           {"log", figure.has_log_y},
           {"sky", figure.is_sky},
           {"xspan", span_json(figure.x_span)},
           {"yspan", span_json(figure.y_span)},
           {"lines", lines}};
  if (figure.has_log_x)
    out["xlog"] = true;
  if (!figure.y_names.empty())
    out["ynames"] = figure.y_names;
  return out;
}

namespace {

Result<std::string> page_of(Json data, const std::vector<PlotFigure> &figures) {
  for (const PlotFigure &figure : figures)
    data["figures"].push_back(figure_json(figure));
  return fill_plot_page(plot_page_template(), data, plot_page_js());
}

} // namespace

Result<std::string> make_plot_page(const std::string &title, const std::vector<PlotFigure> &figures,
                                   const std::vector<std::string> &notes) {
  return page_of({{"title", title}, {"figures", Json::array()}, {"notes", notes}}, figures);
}

Result<std::string> make_answer_page(const std::string &title,
                                     const std::vector<PlotFigure> &figures,
                                     const std::vector<std::string> &notes) {
  if (notes.empty())
    return make_plot_page(title, figures, notes);
  const std::vector<std::string> rest(notes.begin() + 1, notes.end());
  return page_of(
      {{"title", title}, {"lead", notes.front()}, {"figures", Json::array()}, {"notes", rest}},
      figures);
}

} // namespace umov
