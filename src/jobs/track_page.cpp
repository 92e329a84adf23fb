#include "jobs/fit_figures.h"
#include "jobs/track_tables.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/frames/sky.h>

namespace umov::jobs {
namespace {

using Numbers = std::vector<double>;

/// Rows of one filter, or of the heaviest at each time, of a table of a tracking.
struct Rows {
  std::vector<std::size_t> of;
  TimeAxis time; ///< of those
};

Rows rows_of(std::vector<std::size_t> of, const TimeAxis &all) {
  Rows out;
  out.time.title = all.title;
  for (const std::size_t k : of) {
    out.time.x.push_back(all.x[k]);
    out.time.stretch.push_back(all.stretch[k]);
  }
  out.of = std::move(of);
  return out;
}

/// A column against time, broken at gaps.
PlotLine line_of(const Table &track, const Rows &rows, const char *column, std::string name,
                 std::size_t colour) {
  PlotLine out{std::move(name), {}, {}, colour, plot_dash(colour)};
  for (std::size_t n = 0; n < rows.of.size(); ++n) {
    if (n > 0 && rows.time.stretch[n] != rows.time.stretch[n - 1]) {
      out.x.push_back(rows.time.x[n]);
      out.y.push_back(std::nan(""));
    }
    out.x.push_back(rows.time.x[n]);
    out.y.push_back(track.number(column, rows.of[n]));
  }
  return out;
}

/// Bars of one standard deviation.
PlotLine bars_of(const Table &track, const Rows &rows, const char *column, const char *errors,
                 std::size_t colour) {
  PlotLine out{{}, {}, {}, colour};
  out.is_faint = true;
  for (std::size_t n = 0; n < rows.of.size(); ++n) {
    const double y = track.number(column, rows.of[n]), e = track.number(errors, rows.of[n]);
    for (const double at : {y - e, y + e, std::nan("")}) {
      out.x.push_back(rows.time.x[n]);
      out.y.push_back(at);
    }
  }
  return out;
}

PlotFigure axes_figure(const Table &track, const Rows &heaviest) {
  PlotFigure out{"Where the body's axes point: the heaviest attitude at each epoch",
                 "right ascension [deg]",
                 "declination [deg]",
                 {}};
  out.x_span = {0, 360};
  out.y_span = {-90, 90};
  for (int axis = 0; axis < 3; ++axis) {
    PlotLine line{fmt::format("+{}", "XYZ"[axis]), {}, {}, static_cast<std::size_t>(axis)};
    line.has_markers = true;
    for (const std::size_t k : heaviest.of) {
      const Quaternion q{track.number("qw", k), track.number("qx", k), track.number("qy", k),
                         track.number("qz", k)};
      const SkyDirection to = sky_direction(rotation_from<Body, Gcrs>(q).row(axis));
      line.x.push_back(to.right_ascension.degrees());
      line.y.push_back(to.declination.degrees());
    }
    out.lines.push_back(std::move(line));
  }
  return out;
}

/// Filters, those that weighed most first.
std::vector<std::int64_t> heaviest_numbers(const Table &track, std::size_t most) {
  const auto &number = std::get<std::vector<std::int64_t>>(track.find("mode")->cells);
  std::vector<std::pair<double, std::int64_t>> top;
  for (std::size_t k = 0; k < number.size(); ++k) {
    const auto found = std::ranges::find(top, number[k], &std::pair<double, std::int64_t>::second);
    const double weight = track.number("weight", k);
    if (found == top.end())
      top.emplace_back(weight, number[k]);
    else
      found->first = std::max(found->first, weight);
  }
  std::ranges::stable_sort(top, std::greater<>(), &std::pair<double, std::int64_t>::first);
  std::vector<std::int64_t> out;
  for (std::size_t k = 0; k < std::min(most, top.size()); ++k)
    out.push_back(top[k].second);
  std::ranges::sort(out);
  return out;
}

PlotFigure weights_figure(const Table &track, const TimeAxis &time) {
  PlotFigure out{"Weights of the attitudes", time.title, "share of the probability", {}};
  out.y_span = {-0.03, 1.03};
  const auto &number = std::get<std::vector<std::int64_t>>(track.find("mode")->cells);
  constexpr std::size_t most = 8;
  std::size_t colour = 0;
  for (const std::int64_t wanted : heaviest_numbers(track, most)) {
    std::vector<std::size_t> of;
    for (std::size_t k = 0; k < number.size(); ++k)
      if (number[k] == wanted)
        of.push_back(k);
    PlotLine line =
        line_of(track, rows_of(of, time), "weight", fmt::format("mode {}", wanted), colour);
    line.has_markers = of.size() < 3; // a line of one point is not seen
    out.lines.push_back(std::move(line));
    ++colour;
  }
  return out;
}

} // namespace

std::string track_page(const std::string &title, const Table &fit, const Table &track,
                       const std::string &summary) {
  const auto &utc = std::get<std::vector<std::string>>(track.find("time_utc")->cells);
  const TimeAxis time = time_axis(utc);
  std::vector<PlotFigure> figures;
  add_data_figures(figures, fit);
  if (!time.x.empty()) {
    std::vector<std::size_t> first;
    for (std::size_t k = 0; k < utc.size(); ++k)
      if (k == 0 || utc[k] != utc[k - 1])
        first.push_back(k);
    const Rows heaviest = rows_of(first, time);
    PlotFigure rates{"Rate of the heaviest attitude, body axes", time.title, "rate [deg/s]", {}};
    PlotFigure errors{
        "How well the heaviest attitude is known", time.title, "standard deviation [deg]", {}};
    errors.has_log_y = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const char axis = "xyz"[k];
      const std::string rate = fmt::format("rate_{}", axis), sd = fmt::format("sd_{}", axis);
      rates.lines.push_back(
          bars_of(track, heaviest, rate.c_str(), fmt::format("rate_sd_{}", axis).c_str(), k));
      rates.lines.push_back(
          line_of(track, heaviest, rate.c_str(), fmt::format("about +{}", "XYZ"[k]), k));
      errors.lines.push_back(
          line_of(track, heaviest, sd.c_str(), fmt::format("about +{}", "XYZ"[k]), k));
    }
    PlotLine off{"", heaviest.time.x, {}, 0};
    for (const std::size_t k : heaviest.of)
      off.y.push_back(track.number("chi2", k) / std::max(track.number("measurements", k), 1.0));
    off.has_markers = true;
    figures.push_back(axes_figure(track, heaviest));
    figures.push_back(std::move(rates));
    figures.push_back(std::move(errors));
    figures.push_back(weights_figure(track, time));
    figures.push_back({"What came against what was expected: 1 is what errors make",
                       time.title,
                       "chi-square of the innovation a number",
                       {off}});
  }
  const auto page = make_answer_page(title, figures, page_lines(summary));
  return page ? *page : std::string();
}

} // namespace umov::jobs
