// Tables of Earth orientation that a user gives.

#include "fuzz/target.h"

#include <cmath>
#include <umov/time/earth_orientation.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  if (!fuzz::is_read(use_earth_orientation(fuzz::text_of(data, size), "input")))
    return 0;
  const EarthOrientationTable table = earth_orientation_table();
  fuzz::require(mjd(table.last) > mjd(table.first), "a table has two days or more");
  for (const double day : {mjd(table.first), mjd(table.first) + 0.5, mjd(table.last)}) {
    const EarthOrientation eo = earth_orientation({2400000.5, day});
    // A second at midnight is let be, and on it a tenth before a leap second.
    fuzz::require(eo.is_covered && std::abs(eo.dut1_s) <= 1.1 && std::isfinite(eo.x_p_rad),
                  "a day of the table has a plausible orientation");
  }
  use_built_in_earth_orientation();
  return 0;
}
