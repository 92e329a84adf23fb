#include <umov/jobs/calibrate.h>

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <fmt/format.h>
#include <tuple>
#include <umov/core/text.h>
#include <umov/io/table.h>
#include <umov/jobs/reduce.h>
#include <umov/time/epoch.h>

namespace umov::jobs {
namespace {

std::string note_of(const CountsFile &counts, const char *name) {
  const auto found = counts.notes.find(name);
  return found == counts.notes.end() ? "" : found->second;
}

/// No set of a standard: for want of its name, or of q and u.
std::string no_standard(const Table &table, const std::vector<PolarizedStandard> &standards) {
  std::vector<std::string> seen, known;
  for (const PolarizedStandard &one : standards)
    known.push_back(printable(one.name));
  for (std::size_t k = 0; k < table.rows(); ++k)
    if (const std::string name = printable(table.text("name", k));
        std::ranges::find(seen, name) == seen.end())
      seen.push_back(name);
  for (const std::string &name : seen)
    if (std::ranges::find(known, name) != known.end())
      return fmt::format("no set of \"{}\" has q and u; see the flags of umov reduce", name);
  constexpr std::size_t most = 5;
  return fmt::format("no name of the counts ({}) is that of a standard ({}); the column \"name\" "
                     "of both must agree",
                     listed(seen, most), listed(known, most));
}

/// A fit that rests on little, or that its own errors do not explain.
void warn_of_standards(const std::vector<StandardMeasurement> &data,
                       const PolarimeterCalibration &found, Diagnostics &diagnostics) {
  const double first = data.front().axis_rad;
  constexpr double apart = pi / 180;
  if (std::ranges::none_of(data, [&](const StandardMeasurement &one) {
        return std::abs(std::remainder(one.axis_rad - first, pi)) > apart;
      }))
    diagnostics.warn("all standards stand at one angle of the instrument: phi0 and q0, u0 are told "
                     "apart by what the tables say of the stars alone. Turn the instrument, or "
                     "take a plate");
  constexpr double chance = 1e-3;
  if (found.dof > 0 && boost::math::gamma_q(found.dof / 2., found.chi2 / 2) < chance)
    diagnostics.warn(fmt::format("chi2 = {:.3g} of {} degrees of freedom: the standards disagree "
                                 "by more than their errors. Is a name, an angle or x_axis_pa "
                                 "wrong?",
                                 found.chi2, found.dof));
}

} // namespace

Result<CalibrationFile> calibrate(const CountsFile &counts,
                                  const std::vector<PolarizedStandard> &standards,
                                  Diagnostics &diagnostics) {
  CalibrationFile out;
  out.band = counts.rows.front().band;
  out.instrument = note_of(counts, "instrument");
  out.pol_frame = note_of(counts, "pol_frame");
  out.made_utc = to_iso(counts.rows.back().time);
  if (!out.pol_frame.empty() && out.pol_frame != "equatorial")
    return fail(ErrorCode::BadInput, "standards have position angles from north: counts in the "
                                     "frame \"" +
                                         out.pol_frame + "\" cannot be held against them");
  for (const CountRow &row : counts.rows)
    if (row.band != out.band)
      return fail(ErrorCode::BadInput,
                  "two bands, " + out.band + " and " + row.band + ": calibrate each by itself");
  UMOV_ASSIGN(table, reduce(counts, {}, {}, diagnostics));
  std::vector<StandardMeasurement> data;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    const std::string name = table.text("name", k);
    const auto star = std::ranges::find(standards, name, &PolarizedStandard::name);
    const std::complex<double> z(table.number("q", k), table.number("u", k));
    if (star == standards.end() || !std::isfinite(z.real()))
      continue;
    const double axis = table.number("x_axis_pa", k) * pi / 180;
    const double variance = (table.number("cov_qq", k) + table.number("cov_uu", k)) / 2;
    data.push_back({z * std::polar(1.0, -2 * axis), std::polar(star->p, 2 * star->angle_rad), axis,
                    std::sqrt(variance), static_cast<std::size_t>(star - standards.begin()),
                    star->p_sd, star->angle_sd});
  }
  if (data.empty())
    return fail(ErrorCode::BadInput, no_standard(table, standards));
  UMOV_ASSIGN(calibration, calibrate_polarimeter(data));
  out.calibration = calibration;
  warn_of_standards(data, calibration, diagnostics);
  for (const Warning &one : diagnostics.warnings())
    out.warnings.push_back(one.message);
  return out;
}

Result<void> check_calibration(const CalibrationFile &file, const CountsFile &counts,
                               const std::string &path, Diagnostics &diagnostics) {
  const CountRow &first = counts.rows.front();
  const auto strange =
      std::ranges::find_if(counts.rows, [&](const CountRow &row) { return row.band != file.band; });
  const CountRow &of_band = strange == counts.rows.end() ? first : *strange;
  for (const auto &[what, own, other] :
       {std::tuple{"instrument", file.instrument, note_of(counts, "instrument")},
        {"band", file.band, of_band.band}})
    if (!own.empty() && !other.empty() && own != other)
      return fail(ErrorCode::BadInput,
                  fmt::format("this calibration is of the {} \"{}\", the counts are of \"{}\"; "
                              "calibrate that one",
                              what, own, other),
                  {path});
  if (!file.pol_frame.empty() && file.pol_frame != "equatorial")
    return fail(
        ErrorCode::BadInput,
        fmt::format("this calibration has its angles in the frame \"{}\"; those of standards "
                    "are from north: \"equatorial\" was expected. Calibrate again",
                    file.pol_frame),
        {path});
  constexpr double old_days = 30;
  if (const auto made = utc_from_iso(file.made_utc))
    if (const double days = seconds_between(first.time, *made) / 86400; days > old_days)
      diagnostics.warn(fmt::format("the calibration is {:.0f} days older than the counts", days),
                       {path});
  return {};
}

} // namespace umov::jobs
