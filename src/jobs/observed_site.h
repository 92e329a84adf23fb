#pragma once
// Private: whether observations were taken where the scenario has its observer.

#include <umov/io/observations_file.h>
#include <umov/io/scenario.h>

namespace umov::jobs {

/// BadInput where the header of a file, as `umov observe` and `umov reduce` write it (site_lat_deg,
/// site_lon_deg, site_alt_m), tells another place than the scenario's [observer], as which its rows
/// would be taken. Rows that name a site of their own are taken as of that, and a header without a
/// place says nothing.
Result<void> check_site(const ObservationsFile &file, const Scenario &scenario);

} // namespace umov::jobs
