#pragma once
// Mean elements as published: TLE and 3LE.

#include <string>
#include <string_view>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>
#include <umov/time/epoch.h>
#include <vector>

namespace umov {

/// A SGP4 mean element set. Angles in radians, motion in radians per minute.
struct ElementSet {
  std::string name; ///< "" if the set has no name line
  int norad_cat_id = 0;
  std::string international_designator;
  char classification = 'U';
  int epoch_year = 0;           ///< four digits
  double epoch_day_of_year = 0; ///< 1.0 = 1 January, 0h UTC
  Epoch<Utc> epoch{};
  double mean_motion_dot = 0,
         mean_motion_ddot = 0; ///< as printed: rev/day^2 (halved), rev/day^3 (sixth)
  double bstar = 0;            ///< 1/Earth radii
  double inclination = 0, raan = 0, eccentricity = 0, argument_of_perigee = 0, mean_anomaly = 0;
  double mean_motion = 0; ///< Kozai, rad/min
  int element_number = 0, revolution = 0, ephemeris_type = 0;
  std::size_t line = 0; ///< line of its first element line in the file
};

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
