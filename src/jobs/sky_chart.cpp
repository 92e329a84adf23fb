// Tracks of passes over a site's sky.

#include <umov/jobs/passes.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/io/plot_page.h>
#include <umov/observation/epochs.h>

namespace umov::jobs {
namespace {

constexpr std::size_t passes_max = 40; ///< more is a tangle

bool has_any(const PlotLine &line) {
  return std::ranges::any_of(line.x, [](double x) { return !std::isnan(x); });
}

/// The sunlit and the dark part of a pass, each with gaps where the other is.
void add_pass(const Trajectory &orbit, const SitePass &pass, const Site &site, ShadowModel shadow,
              std::size_t colour, PlotFigure &figure) {
  const std::string id = pass_id(orbit, pass.whole_culmination);
  PlotLine lit{id, {}, {}, colour, "solid", {}}, dark{"", {}, {}, colour, "dot", {}};
  constexpr int points = 120;
  const double length = seconds_between(pass.set.time, pass.rise.time);
  for (int i = 0; i <= points; ++i) {
    const Epoch<Utc> time = plus_seconds(pass.rise.time, length * i / points);
    const auto state = orbit.at(time);
    if (!state)
      continue;
    const ObservingGeometry g = observe(*state, time, site, shadow);
    const bool is_end = i == 0 || i == points;
    for (PlotLine *line : {&lit, &dark}) {
      const bool is_on = (g.sunlit > 0.5) == (line == &lit);
      line->x.push_back(is_on ? g.azimuth.degrees() : std::nan(""));
      line->y.push_back(is_on ? g.altitude.degrees() : std::nan(""));
      line->labels.push_back(is_on && is_end ? to_iso(time).substr(11, 8) : "");
    }
  }
  const bool is_lit = has_any(lit);
  if (is_lit)
    figure.lines.push_back(std::move(lit));
  if (has_any(dark)) {
    dark.name = id + (is_lit ? ", in the shadow" : "");
    figure.lines.push_back(std::move(dark));
  }
}

} // namespace

Result<std::string> sky_chart(const PassesRequest &request, const PassesResult &result) {
  PlotFigure figure{"Passes over the site", "", "", {}, false, true};
  for (std::size_t k = 0; k < std::min(result.found.size(), passes_max); ++k)
    add_pass(result.orbits[result.found[k].object], result.found[k].pass, request.site,
             request.shadow, k % 7, figure);
  std::vector<std::string> notes{
      "The sky overhead: zenith in the middle, north up, east left. Times are UTC.",
      "Dotted: more than half of the Sun's disk is behind the Earth."};
  if (result.found.size() > passes_max)
    notes.push_back(
        fmt::format("The first {} of {} passes are drawn.", passes_max, result.found.size()));
  const std::string &name = request.site.name;
  return make_plot_page("Passes over " + (name.empty() ? "the site" : name), {figure}, notes);
}

} // namespace umov::jobs
