#pragma once
#include <string>
#include <string_view>
#include <umov/core/quantity.h>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// A star of known polarization.
struct PolarizedStandard {
  std::string name;
  double p = 0;         ///< degree
  double angle_rad = 0; ///< position angle from north
  double p_sd = 0;      ///< standard deviation of p; 0: taken as known
  double angle_sd = 0;  ///< of the angle [rad]
};

/// Reads a CSV or ECSV with the columns name, p_percent and pa_deg, and p_err_percent and
/// pa_err_deg where the table knows them; an unpolarized star has p_percent 0. BadInput with line
/// for what is missing or no number.
Result<std::vector<PolarizedStandard>> read_standards_text(std::string_view text,
                                                           const std::string &file);

} // namespace umov
