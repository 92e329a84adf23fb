#include "jobs/fit_figures.h"

#include "jobs/band_colours.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <initializer_list>
#include <optional>
#include <umov/core/constants.h>
#include <umov/core/median.h>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <umov/time/epoch.h>
#include <utility>

namespace umov::jobs {
namespace {

using Numbers = std::vector<double>;

/// The time from which on there is a gap: ten usual steps, at least ten minutes.
double gap_s(const Numbers &at) {
  Numbers steps;
  for (std::size_t k = 1; k < at.size(); ++k)
    if (at[k] > at[k - 1])
      steps.push_back(at[k] - at[k - 1]);
  if (steps.empty())
    return 600;
  return std::max(600.0, 10 * median_of(std::move(steps)));
}

} // namespace

TimeAxis time_axis(const std::vector<std::string> &utc) {
  TimeAxis out;
  Numbers at;
  std::optional<Epoch<Utc>> first;
  for (const std::string &text : utc) {
    const auto time = utc_from_iso(text);
    if (!time)
      return out;
    first = first ? first : *time;
    at.push_back(seconds_between(*time, *first));
  }
  const double gap = gap_s(at);
  double left_out = 0, shown = 0;
  std::size_t stretch = 0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (k > 0 && at[k] - at[k - 1] > gap) {
      left_out += at[k] - at[k - 1] - gap / 10;
      ++stretch;
    }
    shown = at[k] - left_out;
    out.x.push_back(shown);
    out.stretch.push_back(stretch);
  }
  const auto [unit, name] = shown < 600        ? std::pair{1.0, "seconds"}
                            : shown < 4 * 3600 ? std::pair{60.0, "minutes"}
                                               : std::pair{3600.0, "hours"};
  for (double &x : out.x)
    x /= unit;
  if (!utc.empty())
    out.title =
        fmt::format("{} since {}{}", name, utc.front(),
                    stretch > 0 ? fmt::format(", {} left out", counted(stretch, "gap")) : "");
  return out;
}

namespace {

/// One band of a table of a fit: which rows, and how it is drawn.
struct BandRows {
  std::string name;
  std::size_t colour = 0;
  std::vector<std::size_t> rows;
};

std::vector<BandRows> fitted_bands(const Table &fit) {
  std::vector<BandRows> out;
  const auto &bands = std::get<std::vector<std::string>>(fit.find("band")->cells);
  for (std::size_t k = 0; k < bands.size(); ++k) {
    auto found = std::ranges::find(out, bands[k], &BandRows::name);
    if (found == out.end())
      found = out.insert(out.end(), {bands[k], 0, {}});
    found->rows.push_back(k);
  }
  std::ranges::sort(out, {}, &BandRows::name);
  std::vector<std::string> names;
  names.reserve(out.size());
  for (const BandRows &one : out)
    names.push_back(one.name);
  const std::vector<std::size_t> colours = band_colours(names);
  for (std::size_t b = 0; b < out.size(); ++b)
    out[b].colour = colours[b];
  return out;
}

/// Points of a column, less another one if there is one; a line is broken at gaps.
PlotLine points_of(const Table &fit, const BandRows &band, const TimeAxis &time, bool is_line,
                   const char *column, const char *less = nullptr) {
  PlotLine out{band.name, {}, {}, band.colour};
  out.has_markers = !is_line;
  for (std::size_t n = 0; n < band.rows.size(); ++n) {
    const std::size_t k = band.rows[n];
    if (is_line && n > 0 && time.stretch[k] != time.stretch[band.rows[n - 1]]) {
      out.x.push_back(time.x[k]);
      out.y.push_back(std::nan(""));
    }
    out.x.push_back(time.x[k]);
    out.y.push_back(fit.number(column, k) - (less != nullptr ? fit.number(less, k) : 0));
  }
  return out;
}

/// Bars of one standard deviation behind the points.
PlotLine bars_of(const Table &fit, const BandRows &band, const PlotLine &points,
                 const char *errors) {
  PlotLine out{{}, {}, {}, band.colour};
  out.is_faint = true;
  for (std::size_t k = 0; k < band.rows.size(); ++k) {
    const double error = fit.number(errors, band.rows[k]);
    for (const double y : {points.y[k] - error, points.y[k] + error, std::nan("")}) {
      out.x.push_back(points.x[k]);
      out.y.push_back(y);
    }
  }
  return out;
}

/// Lines that hold a number.
void add_lines(PlotFigure &figure, std::initializer_list<PlotLine> lines) {
  for (const PlotLine &line : lines)
    if (std::ranges::any_of(line.y, [](double y) { return std::isfinite(y); }))
      figure.lines.push_back(line);
}

/// Points x with (x - c)^T C^-1 (x - c) = sigmas^2, of two numbers of a covariance.
PlotLine ellipse(const FittedNumbers &n, std::size_t a, std::size_t b, double sigmas) {
  const std::size_t size = n.name.size();
  const double aa = std::max(n.covariance[a * size + a], 0.0), ab = n.covariance[a * size + b];
  const double bb = std::max(n.covariance[b * size + b], 0.0);
  // Cholesky of the two by two.
  const double first = std::sqrt(aa), along = first > 0 ? ab / first : 0;
  const double across = std::sqrt(std::max(bb - along * along, 0.0));
  PlotLine out{fmt::format("{:g} sigma", sigmas), {}, {}, sigmas > 1 ? 1u : 0u};
  constexpr int points = 90;
  for (int k = 0; k <= points; ++k) {
    const double t = 2 * pi * k / points, c = sigmas * std::cos(t), s = sigmas * std::sin(t);
    out.x.push_back(n.value[a] + first * c);
    out.y.push_back(n.value[b] + along * c + across * s);
  }
  return out;
}

/// Polarization of less than a rounded intermediate is none: an axis of 1e-12 would say that
/// something is seen. Where nothing is, the axis has the size of what could have been.
void drop_rounding(PlotFigure &figure) {
  constexpr double rounding = 1e-9, seen = 1e-6, span = 0.01;
  double largest = 0;
  for (PlotLine &line : figure.lines)
    for (double &y : line.y) {
      y = std::abs(y) < rounding ? 0 : y;
      largest = std::isfinite(y) ? std::max(largest, std::abs(y)) : largest;
    }
  if (!figure.lines.empty() && largest < seen)
    figure.y_span = {-span, span};
}

} // namespace

void add_data_figures(std::vector<PlotFigure> &figures, const Table &fit) {
  const TimeAxis time = time_axis(std::get<std::vector<std::string>>(fit.find("time_utc")->cells));
  if (time.x.empty())
    return;
  PlotFigure light{"Brightness: measured and fitted", time.title, "I [m2/sr]", {}};
  PlotFigure left{"Brightness left over", time.title, "measured - fitted [m2/sr]", {}};
  PlotFigure polarization{
      "Polarization: measured and fitted", time.title, "q (scattering plane)", {}};
  for (const BandRows &band : fitted_bands(fit)) {
    for (const auto &[figure, column, model, errors] :
         {std::tuple{&light, "intensity", "intensity_model", "intensity_err"},
          {&polarization, "q_scat", "q_scat_model", "q_err"}}) {
      const PlotLine seen = points_of(fit, band, time, false, column);
      PlotLine fitted = points_of(fit, band, time, true, model);
      fitted.name += ", fit";
      const PlotLine bars = bars_of(fit, band, seen, errors);
      add_lines(*figure, {bars, seen, fitted});
    }
    const PlotLine rest = points_of(fit, band, time, false, "intensity", "intensity_model");
    const PlotLine bars = bars_of(fit, band, rest, "intensity_err");
    add_lines(left, {bars, rest});
  }
  drop_rounding(polarization);
  for (const PlotFigure *figure : {&light, &left, &polarization})
    if (!figure->lines.empty())
      figures.push_back(*figure);
}

void add_error_figures(std::vector<PlotFigure> &figures, const FittedNumbers &numbers) {
  constexpr std::size_t most = 6; // more are for samples and a program
  std::size_t drawn = 0;
  for (std::size_t a = 0; a < numbers.name.size(); ++a)
    for (std::size_t b = a + 1; b < numbers.name.size() && drawn < most; ++b, ++drawn) {
      PlotLine best{"best fit", {numbers.value[a]}, {numbers.value[b]}, 2};
      best.has_markers = true;
      figures.push_back({fmt::format("Errors: {} and {}", numbers.name[a], numbers.name[b]),
                         numbers.name[a],
                         numbers.name[b],
                         {ellipse(numbers, a, b, 1), ellipse(numbers, a, b, 2), best}});
    }
}

PlotFigure parts_figure(const std::string &title, const std::string &x_title,
                        const std::vector<PartAnswer> &parts) {
  PlotFigure out{title, x_title, "", {}};
  double low = 0, high = 0; // no change is always seen
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const PartAnswer &part = parts[k];
    out.y_names.push_back(part.part);
    if (!std::isfinite(part.value) || !std::isfinite(part.error))
      continue;
    const double y = static_cast<double>(k) + 1;
    PlotLine point{part.part, {part.value}, {y}, k};
    point.has_markers = true;
    PlotLine bar{{}, {part.value - part.error, part.value + part.error}, {y, y}, k};
    bar.is_faint = true;
    low = std::min(low, bar.x[0]);
    high = std::max(high, bar.x[1]);
    out.lines.push_back(std::move(bar));
    out.lines.push_back(std::move(point));
  }
  const double margin = 0.05 * (high - low);
  out.x_span = {low - margin, high + margin};
  out.y_span = {static_cast<double>(parts.size()) + 0.5, 0.5}; // the first on top
  return out;
}

std::vector<std::string> page_lines(const std::string &summary) {
  std::vector<std::string> out;
  for (std::string_view rest = summary; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    line.remove_prefix(line.starts_with("- ") ? 2 : 0);
    out.emplace_back(line);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return out;
}

} // namespace umov::jobs
