#pragma once
// How the Earth turns: UT1-UTC and polar motion, from the table of the IERS.

#include <filesystem>
#include <string>
#include <string_view>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>
#include <umov/time/epoch.h>

namespace umov {

/// Earth orientation at a time. Polar motion as IERS Conventions (2010), section 5.4.1.
struct EarthOrientation {
  double dut1_s = 0;               ///< UT1-UTC [s]
  double x_p_rad = 0, y_p_rad = 0; ///< of the pole in the ITRS [rad]
  bool is_covered = true;          ///< false: outside the table, whose nearest day is held
};

/// Linear between the days of the table, the jump of a leap second apart. After its last day that
/// day's values are held; before its first, zeros.
EarthOrientation earth_orientation(Epoch<Utc> time);

/// The table in use.
struct EarthOrientationTable {
  std::string name;         ///< "IERS finals2000A, compiled in", or a file
  Epoch<Utc> first, last;   ///< days it covers
  Epoch<Utc> measured_last; ///< days after it are predicted; `last` where none is
};
/// What earth_orientation reads.
EarthOrientationTable earth_orientation_table();

/// Takes another table for the whole process, before any time is converted: the text of IERS
/// finals2000A (fixed columns) or of a CSV with columns mjd, x_arcsec, y_arcsec, ut1_utc_s and
/// optionally is_predicted (0 or 1). BadInput with line unless it has two days or more, one after
/// the other, of |x|, |y| <= 2 arcsec and |UT1-UTC| <= 1 s.
Result<void> use_earth_orientation(std::string_view text, const std::string &name);
/// Back to the table that is compiled in.
void use_built_in_earth_orientation();
/// The same as use_earth_orientation from a file.
Result<void> use_earth_orientation_file(const std::filesystem::path &file);

/// Warns once if a span leaves the table, with the size of the error at that epoch.
void warn_if_outside_eop(Epoch<Utc> first, Epoch<Utc> last, Diagnostics &diagnostics);

} // namespace umov
