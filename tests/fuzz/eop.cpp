// Tables of Earth orientation that a user gives.

#include "fuzz/target.h"

#include <cmath>
#include <umov/core/diagnostics.h>
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
  for (const bool is_after : {false, true}) {
    const Epoch<Utc> beyond{2400000.5, is_after ? mjd(table.last) + 3 : mjd(table.first) - 3};
    const EarthOrientation eo = earth_orientation(beyond);
    fuzz::require(!eo.is_covered && std::abs(eo.dut1_s) <= 1, "days beyond it are told apart");
    Diagnostics said;
    warn_if_outside_eop(table.first, table.last, said);
    fuzz::require(said.warnings().empty(), "nothing is said of the days of the table");
    warn_if_outside_eop(is_after ? table.first : beyond, is_after ? beyond : table.last, said);
    fuzz::require(said.warnings().size() == 1, "a day beyond is warned of");
  }
  use_built_in_earth_orientation();
  return 0;
}
