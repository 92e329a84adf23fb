#pragma once
// Two-line elements: TLE and 3LE texts.

#include <cstddef>
#include <string>
#include <string_view>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>
#include <umov/orbit/elements.h>
#include <vector>

namespace umov {

/// What is tolerated in a file of elements.
struct TleOptions {
  bool allow_bad_checksum = false;
  bool keep_going = false;             ///< report a bad set as a warning and keep the others
  std::size_t limit_bytes = 64u << 20; ///< a longer text is refused before anything is stored
};

/// Reads every set of a TLE or 3LE text (`file` is for messages). Blank lines and `#` comments are
/// skipped; lines end with LF, CRLF or CR. Refused, with line and column: anything that does not
/// stand in its columns, wrong checksums (unless allowed), values out of range, SGP4-XP sets.
/// Accepted with a warning: no checksum (68 columns), day 366 of a common year (rolled over to
/// 1 January), names that are not UTF-8. At most a hundred warnings of one kind are listed, then
/// their number. The age of elements is the caller's concern.
Result<std::vector<ElementSet>> read_tle(std::string_view text, const std::string &file,
                                         const TleOptions &options, Diagnostics &diagnostics);

} // namespace umov
