#include "jobs/invert_page.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <initializer_list>
#include <optional>
#include <umov/core/quantity.h>
#include <umov/core/rotation.h>
#include <umov/core/text.h>
#include <umov/frames/sky.h>
#include <umov/inverse/attitude_grid.h>
#include <umov/io/plot_page.h>
#include <umov/time/epoch.h>

namespace umov::jobs {
namespace {

constexpr std::size_t drawn_samples = 1000; ///< as many as a page draws without delay
using Numbers = std::vector<double>;

/// When the rows were measured, from the first on; long gaps, as between passes, are left out.
struct TimeAxis {
  Numbers x;
  std::vector<std::size_t> stretch; ///< of each row: those of one have no gap between them
  std::string title;
};

/// The time from which on there is a gap: ten usual steps, at least ten minutes.
double gap_s(const Numbers &at) {
  Numbers steps;
  for (std::size_t k = 1; k < at.size(); ++k)
    if (at[k] > at[k - 1])
      steps.push_back(at[k] - at[k - 1]);
  if (steps.empty())
    return 600;
  std::ranges::nth_element(steps, steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2));
  return std::max(600.0, 10 * steps[steps.size() / 2]);
}

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
  for (std::size_t b = 0; b < out.size(); ++b)
    out[b].colour = b;
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

/// Data and fit, and what is left over.
void add_data(std::vector<PlotFigure> &figures, const Table &fit) {
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
  for (const PlotFigure *figure : {&light, &left, &polarization})
    if (!figure->lines.empty())
      figures.push_back(*figure);
}

/// Samples of equal weight: at even steps of the sum of the weights.
std::vector<Quaternion> equal_samples(const PoseAnswer &answer) {
  std::vector<Quaternion> out;
  double sum = 0;
  for (const PoseSample &sample : answer.samples) {
    sum += sample.weight;
    while (static_cast<double>(out.size()) + 0.5 < sum * drawn_samples &&
           out.size() < drawn_samples)
      out.push_back(sample.turning.attitude);
  }
  return out;
}

/// Where the axes of the body point at the first epoch.
PlotFigure axes_figure(const std::vector<Quaternion> &samples) {
  PlotFigure out{"Where the body's axes point at the first epoch: samples of the posterior",
                 "right ascension [deg]",
                 "declination [deg]",
                 {}};
  out.x_span = {0, 360};
  out.y_span = {-90, 90};
  for (int axis = 0; axis < 3; ++axis) {
    PlotLine line{fmt::format("+{}", "XYZ"[axis]), {}, {}, static_cast<std::size_t>(axis)};
    line.has_markers = true;
    for (const Quaternion &q : samples) {
      const SkyDirection to = sky_direction(rotation_from<Body, Gcrs>(q).row(axis));
      line.x.push_back(to.right_ascension.degrees());
      line.y.push_back(to.declination.degrees());
    }
    out.lines.push_back(std::move(line));
  }
  return out;
}

/// Turn from one attitude to another [deg], as a vector in body axes.
std::array<double, 3> turn_deg(Quaternion from, Quaternion to) {
  const Quaternion d =
      quaternion_from(rotation_from<Body, Gcrs>(to) * rotation_from<Body, Gcrs>(from).inverse());
  const double sine = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  const double scale = sine > 0 ? Angle::radians(2 * std::atan2(sine, d.w)).degrees() / sine : 0;
  return {scale * d.x, scale * d.y, scale * d.z};
}

/// The errors of the heaviest mode, two axes at a time.
void add_corner(std::vector<PlotFigure> &figures, const PoseAnswer &answer,
                const std::vector<Quaternion> &samples) {
  if (answer.modes.empty())
    return;
  const PoseMode &mode = answer.modes.front();
  // Those that are nearer to it than to any other mode.
  std::array<Numbers, 3> turn;
  for (const Quaternion &q : samples) {
    const double own = angle_between(q, mode.turning.attitude);
    if (std::ranges::any_of(answer.modes, [&](const PoseMode &other) {
          return angle_between(q, other.turning.attitude) < own;
        }))
      continue;
    const std::array<double, 3> v = turn_deg(mode.turning.attitude, q);
    for (std::size_t k = 0; k < 3; ++k)
      turn[k].push_back(v[k]);
  }
  for (const auto &[a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
    PlotLine line{{}, turn[static_cast<std::size_t>(a)], turn[static_cast<std::size_t>(b)]};
    line.has_markers = true;
    figures.push_back(
        {fmt::format("Errors of the heaviest attitude: about +{} and +{}", "XYZ"[a], "XYZ"[b]),
         fmt::format("turn about +{} [deg]", "XYZ"[a]),
         fmt::format("turn about +{} [deg]", "XYZ"[b]),
         {line}});
  }
}

std::vector<std::string> page_lines(const std::string &summary, const PoseAnswer &answer) {
  std::vector<std::string> out;
  for (std::string_view rest = summary; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    line.remove_prefix(line.starts_with("- ") ? 2 : 0); // the page has marks of its own
    out.emplace_back(line);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  for (std::size_t k = 0; k < std::min<std::size_t>(answer.modes.size(), 10); ++k) {
    const Quaternion q = answer.modes[k].turning.attitude;
    const double sign = q.w < 0 ? -1 : 1;
    out.push_back(fmt::format("mode {}: weight {:.3f}, q = ({:.5f}, {:.5f}, {:.5f}, {:.5f})", k + 1,
                              answer.modes[k].weight, sign * q.w, sign * q.x, sign * q.y,
                              sign * q.z));
  }
  return out;
}

} // namespace

std::string inversion_page(const std::string &title, const Table &fit, const PoseAnswer &answer,
                           const std::string &summary) {
  std::vector<PlotFigure> figures;
  add_data(figures, fit);
  if (const std::vector<Quaternion> samples = equal_samples(answer); !samples.empty()) {
    figures.push_back(axes_figure(samples));
    add_corner(figures, answer, samples);
  }
  const auto page = make_plot_page(title, figures, page_lines(summary, answer));
  return page ? *page : std::string();
}

} // namespace umov::jobs
