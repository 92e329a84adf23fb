#pragma once
#include <limits>
#include <string>
#include <string_view>
#include <umov/core/quantity.h>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// A star of known polarization, of known brightness, or both. NaN: not known.
struct StandardStar {
  std::string name;
  double p = std::numeric_limits<double>::quiet_NaN(); ///< degree
  double angle_rad = 0;                                ///< position angle from north
  double p_sd = 0;                                     ///< standard deviation of p; 0: known
  double angle_sd = 0;                                 ///< of the angle [rad]
  double mag = std::numeric_limits<double>::quiet_NaN();
  double colour = std::numeric_limits<double>::quiet_NaN(); ///< index, such as B - V
};

/// Reads a CSV or ECSV with the column name and p_percent with pa_deg (and p_err_percent and
/// pa_err_deg where the table knows them; an unpolarized star has p_percent 0), or mag (and
/// colour), or both; empty cells are not known. BadInput with line for what is missing or no
/// number.
Result<std::vector<StandardStar>> read_standards_text(std::string_view text,
                                                      const std::string &file);

/// Tables of standards that come with the program.
std::vector<std::string> standards_names();
/// One of those by its name, or a file that ends in .csv or .ecsv or has a folder; BadInput with
/// the nearest name for what is neither.
Result<std::string> standards_text(const std::string &name_or_path);

} // namespace umov
