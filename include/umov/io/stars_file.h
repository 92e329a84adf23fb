#pragma once
// Stars of a field.

#include <string>
#include <string_view>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// A star of the field.
struct FieldStar {
  double ra_deg = 0, dec_deg = 0; ///< ICRS, of the date
  double mag = 0;                 ///< AB in the band
};

/// Reads CSV or ECSV with the columns ra_deg, dec_deg and mag. BadInput with line and column for
/// what is missing or no number; a warning for a table without a row, which is an empty field.
Result<std::vector<FieldStar>> read_stars_text(std::string_view text, const std::string &file,
                                               Diagnostics &diagnostics);

} // namespace umov
