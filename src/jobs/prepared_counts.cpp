#include "jobs/prepared_counts.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace umov::jobs {
namespace {

/// Plates are at work where their angles change; one that flips has a single angle.
bool has_plate(const CountsFile &file) {
  const auto type = file.notes.find("polarimeter");
  if (type != file.notes.end() && type->second == "flc")
    return true;
  return std::ranges::any_of(
      file.rows, [&](const CountRow &row) { return row.plate_deg != file.rows.front().plate_deg; });
}

/// Light above the air through the calibrated zero point and extinction, at each row's own air
/// mass, in the place of those in its w0.
Result<void> put_photometry(CountsFile &file, const PhotometricCalibration &photometry,
                            double colour) {
  for (CountRow &row : file.rows) {
    if (constexpr double least = 0.99; !(row.airmass >= least) || std::isnan(row.k_mag))
      return fail(ErrorCode::BadInput,
                  "a calibration of brightness on counts without air mass or extinction: columns "
                  "airmass and k_mag (0 where w0 knows no air) were expected");
    const double above = offset_of(photometry, row.airmass, colour).mag;
    // magnitude = that of w0 + k X, which is the one behind the air, + above.
    row.row = row.row * std::pow(10, 0.4 * (row.k_mag * row.airmass + above));
    row.k_mag = photometry.extinction - photometry.second_order * colour;
  }
  return {};
}

/// A time of an object with the axis that the instrument had.
struct Stand {
  Epoch<Utc> time;
  double axis_deg = 0;
  std::vector<std::size_t> rows;
};

/// How fast axes turn at each row, by the exposures before and after.
void put_turns(CountsFile &file) {
  std::map<std::string, std::vector<Stand>> objects;
  for (std::size_t k = 0; k < file.rows.size(); ++k) {
    const CountRow &row = file.rows[k];
    std::vector<Stand> &all = objects[row.name];
    if (all.empty() || seconds_between(row.time, all.back().time) > 1e-6)
      all.push_back({row.time, row.x_axis_pa_deg, {}});
    all.back().rows.push_back(k);
  }
  for (const auto &[name, all] : objects)
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Stand &a = all[k > 0 ? k - 1 : 0], &b = all[std::min(k + 1, all.size() - 1)];
      const double seconds = seconds_between(b.time, a.time);
      for (const std::size_t row : all[k].rows)
        file.rows[row].turn_deg_s =
            seconds > 0 ? std::remainder(b.axis_deg - a.axis_deg, 180) / seconds : 0;
    }
}

} // namespace

bool is_prepared(const ReduceOptions &o) {
  return o.aperture_sd > 0 || o.photometry || o.priors.time_s > 0 || o.priors.plate_rad > 0 ||
         o.priors.retardance_rad > 0 || o.priors.sky_p > 0;
}

Result<CountsFile> prepare(CountsFile file, const ReduceOptions &options) {
  if ((options.priors.plate_rad > 0 || options.priors.retardance_rad > 0) && !has_plate(file))
    return fail(ErrorCode::BadInput, "an error of the plate was given, and these counts know none: "
                                     "their plate_deg is one and the same");
  if (options.priors.sky_p > 0 && std::ranges::any_of(file.rows, [](const CountRow &row) {
        return std::isnan(row.pa_scat_deg);
      }))
    return fail(ErrorCode::BadInput,
                "an error of the sky's polarization (sky_p_sd) was given, and these counts do not "
                "tell its axis: a column pa_scat was expected, the position angle of the normal of "
                "the plane of Sun, object and observer [deg]");
  for (CountRow &row : file.rows)
    row.scintillation = std::hypot(row.scintillation, options.aperture_sd);
  if (options.priors.time_s > 0)
    put_turns(file);
  if (options.photometry)
    UMOV_TRY(put_photometry(file, *options.photometry, options.colour.value_or(solar_colour)));
  return file;
}

} // namespace umov::jobs
