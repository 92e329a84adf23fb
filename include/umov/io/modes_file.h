#pragma once
// modes.ecsv of umov invert, read back.

#include <map>
#include <string>
#include <string_view>
#include <umov/core/result.h>
#include <umov/core/rotation.h>
#include <vector>

namespace umov {

/// One way to be turned, as a table of modes has it.
struct ModesRow {
  double weight = 0, scale = 1;
  Quaternion attitude;     ///< body_from_gcrs, of length 1
  Vec3<Body> rate_rad_s{}; ///< body axes
  /// Of the rotation vector in body axes [rad], with rates also of those [rad/s]: row-major.
  std::vector<double> covariance;
};

/// A table of modes.
struct ModesFile {
  std::vector<ModesRow> rows; ///< with a weight above 0
  bool has_rates = false;
  std::map<std::string, std::string> notes; ///< of its header
};

/// Reads ECSV or CSV with the columns weight, qw, qx, qy, qz, cov_xx ... cov_zz, and where the rate
/// was asked for rate_x ... rate_z and cov_xwx ... cov_wzwz; scale is 1 where there is none.
/// Units that the header tells must be those: none, rad2, deg / s, rad2 / s, rad2 / s2.
/// BadInput with line for what is missing or no number, a quaternion that is not of length 1, a
/// variance that is not above 0, and a table without a mode.
Result<ModesFile> read_modes_text(std::string_view text, const std::string &file);

/// A draw of a posterior, as a table of samples has it.
struct SampleRow {
  double weight = 0, scale = 1;
  Quaternion attitude; ///< body_from_gcrs, of length 1
};
/// Reads samples.ecsv of fixed attitudes: the columns weight, qw, qx, qy, qz and scale; those with
/// a weight above 0, which add up to 1 here. BadInput as above.
Result<std::vector<SampleRow>> read_samples_text(std::string_view text, const std::string &file);

} // namespace umov
