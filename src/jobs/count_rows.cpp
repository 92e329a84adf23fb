#include "jobs/count_rows.h"

#include <umov/core/median.h>

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <utility>

namespace umov::jobs {
namespace {

/// An axis between two others, `share` of the short way from the first [deg], in [0, 180).
double between_axes(double from, double to, double share) {
  const double axis = from + share * std::remainder(to - from, 180);
  return axis - 180 * std::floor(axis / 180);
}

} // namespace

ChannelDatum datum_of(const CountRow &row, const ReduceOptions &options) {
  const StokesRow answers = options.calibration ? calibrated_row(*options.calibration, row.row,
                                                                 row.x_axis_pa_deg * pi / 180)
                                                : row.row;
  return {row.counts, row.sky, row.var_read + row.sky_err * row.sky_err, row.excess2, answers};
}

std::vector<ChannelDatum> data_of(Rows rows, const ReduceOptions &options) {
  std::vector<ChannelDatum> out;
  for (const CountRow &row : rows)
    out.push_back(datum_of(row, options));
  return out;
}

ModelledDatum modelled(const CountRow &row, const ChannelDatum &datum,
                       const std::array<double, 4> &stokes, std::size_t gain) {
  constexpr double degree = pi / 180;
  return {datum,
          stokes,
          row.x_axis_pa_deg * degree,
          gain,
          row.plate_deg * degree,
          row.retardance_deg * degree,
          row.turn_deg_s * degree,
          row.pa_scat_deg * degree};
}

std::vector<std::size_t> gains_of(Rows rows) {
  std::map<std::string, std::size_t> known;
  std::vector<std::size_t> out;
  for (const CountRow &row : rows)
    out.push_back(row.channel.empty() ? out.size()
                                      : known.try_emplace(row.channel, known.size()).first->second);
  return out;
}

CountRow middle_of(Rows rows) {
  CountRow out = rows.front();
  const double half = seconds_between(rows.back().time, out.time) / 2;
  const auto after = std::ranges::find_if(
      rows, [&](const CountRow &row) { return seconds_between(row.time, out.time) >= half; });
  const CountRow &b = *after, &a = after == rows.begin() ? b : *(after - 1);
  const double step = seconds_between(b.time, a.time);
  const double share = step > 0 ? (half - seconds_between(a.time, out.time)) / step : 0;
  out.time = plus_seconds(out.time, half);
  out.x_axis_pa_deg = between_axes(a.x_axis_pa_deg, b.x_axis_pa_deg, share);
  out.ra_deg = a.ra_deg + share * std::remainder(b.ra_deg - a.ra_deg, 360);
  out.dec_deg = a.dec_deg + share * (b.dec_deg - a.dec_deg);
  out.range_km = a.range_km + share * (b.range_km - a.range_km);
  out.airmass = a.airmass + share * (b.airmass - a.airmass);
  out.k_mag = a.k_mag + share * (b.k_mag - a.k_mag);
  out.pa_scat_deg = between_axes(a.pa_scat_deg, b.pa_scat_deg, share);
  out.phase_angle_deg = a.phase_angle_deg + share * (b.phase_angle_deg - a.phase_angle_deg);
  return out;
}

void add_flag(std::string &flags, const char *flag) {
  flags += flags.empty() ? flag : std::string(" ") + flag;
}

namespace {

/// Zero point and extinction are wrong by the same in a whole run: I, Q, U and V move together.
void add_common_light(Reduced &r, const ReduceOptions &options) {
  double variance = options.zero_sd_mag * options.zero_sd_mag;
  if (options.photometry)
    variance +=
        offset_of(*options.photometry, r.middle.airmass, options.colour.value_or(solar_colour))
            .variance;
  const double per_mag = std::log(10.) / 2.5;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b)
      r.fit.covariance[a][b] += r.fit.stokes[a] * r.fit.stokes[b] * variance * per_mag * per_mag;
}

} // namespace

void judge(Reduced &r, const ReduceOptions &options) {
  if (options.calibration && r.is_solved)
    for (std::size_t k = 0; k < 2; ++k)
      r.fractions.covariance[k][k] +=
          common_variance(*options.calibration, {r.fractions.value[0], r.fractions.value[1]});
  add_common_light(r, options);
  constexpr double chance = 1e-6; // of a sound set: none in a long night
  if (r.fit.dof > 0 && boost::math::gamma_q(r.fit.dof / 2., r.fit.chi2 / 2) < chance)
    add_flag(r.flags, "misfit");
  if (r.is_solved && std::hypot(r.fractions.value[0], r.fractions.value[1]) > 1)
    add_flag(r.flags, "above_one");
}

void warn_of_gaps(const std::vector<CountRow> &rows, bool is_series, Diagnostics &diagnostics) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < rows.size(); ++k)
    if (const double step = seconds_between(rows[k].time, rows[k - 1].time); step > 1e-9)
      steps.push_back(step);
  if (steps.size() < 4)
    return;
  const double usual = median_of(std::move(steps));
  std::size_t gaps = 0;
  double longest = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const double step = seconds_between(rows[k].time, rows[k - 1].time);
    const bool is_together = is_series || rows[k].set == rows[k - 1].set;
    if (!is_together || rows[k].name != rows[k - 1].name || !(step > 10 * usual))
      continue;
    ++gaps;
    longest = std::max(longest, step);
  }
  if (gaps > 0)
    diagnostics.warn(
        fmt::format("{} of up to {:.3g} s within {}, where exposures follow each other "
                    "every {:.3g} s: what changed meanwhile is taken for polarization",
                    counted(gaps, "gap"), longest, is_series ? "a series" : "a set", usual));
}

tl::unexpected<Error> all_saturated() {
  return fail(ErrorCode::Physics, "every channel is saturated: there is nothing to reduce");
}

} // namespace umov::jobs
