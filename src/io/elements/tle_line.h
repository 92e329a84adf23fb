#pragma once
// One element line: what its columns may hold, and the fields read from them.

#include <string>
#include <string_view>
#include <umov/core/result.h>
#include <umov/io/tle.h>

namespace umov::tle {

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A line without its end and without trailing blanks.
struct Line {
  std::string_view text;
  std::size_t number = 0; ///< in the file, from 1
};

/// What a line is taken for, before any check.
enum class Kind { Blank, Comment, First, Second, OtherNumber, Name };
/// Judges by the line number and the catalogue number, or by the length; Unicode blanks count as
/// blanks here, so that such a line is refused with its reason instead of passing for a name.
Kind kind_of(std::string_view text);

/// Findings that do not stop the reading.
struct LineNotes {
  bool lacks_checksum = false;
  std::string bad_checksum; ///< the message, if the checksum is wrong but allowed
  std::string odd_epoch;    ///< the message, if day 366 of a common year is read as rollover
};

/// Characters, layout, length and checksum of a line of either kind.
Result<LineNotes> check_line(const Line &line, Kind kind, const std::string &file,
                             const TleOptions &options);
/// Fields of line 1 (into `set`, without `name` and `epoch`).
Result<void> read_first(const Line &line, const std::string &file, ElementSet &set,
                        LineNotes &notes);
/// Fields of line 2; its catalogue number must be that of `set`.
Result<void> read_second(const Line &line, const std::string &file, ElementSet &set);

/// A name as printable UTF-8 without the "0 " of a 3LE; `is_changed` tells of replaced bytes.
std::string clean_name(std::string_view text, bool &is_changed);

} // namespace umov::tle
