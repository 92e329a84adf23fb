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
};

/// Reads a CSV or ECSV with the columns name, p_percent and pa_deg; an unpolarized star has
/// p_percent 0. BadInput with line for what is missing or no number.
Result<std::vector<PolarizedStandard>> read_standards_text(std::string_view text,
                                                           const std::string &file);

} // namespace umov
