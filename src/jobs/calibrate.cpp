#include <umov/jobs/calibrate.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/io/table.h>
#include <umov/jobs/reduce.h>
#include <umov/time/epoch.h>

namespace umov::jobs {
namespace {

std::string note_of(const CountsFile &counts, const char *name) {
  const auto found = counts.notes.find(name);
  return found == counts.notes.end() ? "" : found->second;
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
                    std::sqrt(variance)});
  }
  if (data.empty())
    return fail(ErrorCode::BadInput, "no name of the counts is that of a standard; the column "
                                     "\"name\" of both must agree");
  UMOV_ASSIGN(calibration, calibrate_polarimeter(data));
  out.calibration = calibration;
  return out;
}

} // namespace umov::jobs
