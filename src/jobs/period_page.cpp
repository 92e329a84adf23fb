// The page of umov period: the brightness, its periodogram, and the curve folded.

#include "jobs/band_colours.h"
#include "jobs/period_search.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/io/plot_page.h>

namespace umov::jobs {
namespace {

/// Brightest above: the span of an axis from the faintest to the brightest magnitude.
void turn_over(PlotFigure &figure) {
  double low = 1e300, high = -1e300;
  for (const PlotLine &line : figure.lines)
    for (const double y : line.y) {
      low = std::min(low, y);
      high = std::max(high, y);
    }
  const double margin = 0.05 * std::max(high - low, 1e-3);
  figure.y_span = {high + margin, low - margin};
}

/// Stretches of one time and their colours, a line for each.
struct Bands {
  std::vector<const Stretch *> of;
  std::vector<std::size_t> colours;

  [[nodiscard]] PlotLine line(std::size_t number, std::vector<double> y) const {
    return {of[number]->band, {}, std::move(y), colours[number], plot_dash(number)};
  }
};

/// Brightnesses; `is_level`: less the parabola that the periodogram takes off.
PlotLine points(const Bands &bands, std::size_t number, bool is_level) {
  const Stretch &of = *bands.of[number];
  PlotLine out = bands.line(number, of.magnitudes);
  out.has_markers = true;
  const auto trend = periodogram(of.seconds, of.magnitudes).trend;
  for (std::size_t k = 0; k < out.y.size(); ++k) {
    const double x = of.seconds[k] / std::max(of.seconds.back(), 1e-9);
    out.y[k] -= is_level ? trend[0] + x * (trend[1] + x * trend[2]) : 0;
  }
  return out;
}

PlotFigure curve(const Bands &bands) {
  PlotFigure out{"Brightness",
                 "seconds after " + to_iso(bands.of.front()->begin),
                 bands.of.front()->is_flux ? "-2.5 log of the flux" : "magnitude",
                 {}};
  for (std::size_t b = 0; b < bands.of.size(); ++b) {
    out.lines.push_back(points(bands, b, false));
    out.lines.back().x = bands.of[b]->seconds;
  }
  turn_over(out);
  return out;
}

PlotFigure powers(const Bands &bands) {
  PlotFigure out{"How it repeats: a sine of each period",
                 "period [s]",
                 "part of the variance that it takes",
                 {}};
  out.has_log_x = true;
  constexpr std::size_t drawn = 2000;
  for (std::size_t b = 0; b < bands.of.size(); ++b) {
    const Periodogram found =
        with_fewer_values(periodogram(bands.of[b]->seconds, bands.of[b]->magnitudes), drawn);
    out.lines.push_back(bands.line(b, found.power));
    out.lines.back().x = found.period_s;
  }
  out.y_span = {0, 1};
  return out;
}

PlotFigure folded(const Bands &bands, double period_s, const char *what) {
  PlotFigure out{
      fmt::format("Folded at {:.5g} s{}", period_s, what), "turn", "magnitude less its trend", {}};
  for (std::size_t b = 0; b < bands.of.size(); ++b) {
    out.lines.push_back(points(bands, b, true));
    for (const double t : bands.of[b]->seconds)
      out.lines.back().x.push_back(std::fmod(t / period_s, 1.0));
  }
  turn_over(out);
  return out;
}

} // namespace

Result<std::string> period_page(const ObservationsFile &observations,
                                const PeriodRequest &request) {
  UMOV_ASSIGN(stretches, stretches_of(observations, request));
  UMOV_ASSIGN(best, surest_peak(stretches, request, observations.path));
  Bands bands;
  constexpr std::size_t bands_max = 6; // more are a tangle
  for (const Stretch &one : stretches)
    if (bands.of.size() < bands_max &&
        std::abs(seconds_between(one.begin, best.stretch->begin)) < request.gap_s)
      bands.of.push_back(&one);
  std::vector<std::string> names;
  for (const Stretch *one : bands.of)
    names.push_back(one->band);
  bands.colours = band_colours(names);
  const Repetition repetition = repetition_of(*best.stretch, best.period_s, request.false_alarm);
  const double period_s = repetition.period_s;
  const std::vector<PlotFigure> figures{
      curve(bands), powers(bands), folded(bands, period_s, ""),
      folded(bands, 2 * period_s, ", twice that: do its halves differ?")};
  std::string said = describe(repetition, best.where);
  said.front() = 'L';
  return make_answer_page(
      "Periods of " + observations.path, figures,
      {said + ".",
       "Brightness is taken in magnitudes less a parabola in time; all count alike, whatever "
       "errors "
       "stand beside them; limits are left out. Periods are of the light as the observer saw it "
       "(synodic).",
       "Shown is the stretch with the surest peak; umov period lists those of all."});
}

} // namespace umov::jobs
