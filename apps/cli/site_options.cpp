#include "site_options.h"

#include <umov/io/sites.h>
#include <umov/time/earth_orientation.h>

namespace umov::cli {

void add_site(CLI::App &verb, SiteOptions &o) {
  auto *site = verb.add_option("-s,--site", o.site,
                               "A known site such as maui or paranal, or "
                               "latitude,longitude,altitude: deg north, deg east, m");
  o.latitude = verb.add_option("--lat-deg", o.latitude_deg, "Geodetic latitude, north positive");
  o.longitude = verb.add_option("--lon-deg", o.longitude_deg, "Longitude, east positive");
  o.altitude = verb.add_option("--alt-m", o.altitude_m, "Height above the WGS 84 ellipsoid");
  for (auto *one : {o.latitude, o.longitude, o.altitude})
    one->excludes(site);
  add_earth_orientation(verb, o.earth_orientation);
}

void add_earth_orientation(CLI::App &verb, std::string &file) {
  verb.add_option("--eop", file,
                  "Table of Earth orientation (IERS finals2000A) in place of the compiled-in one");
}

Result<void> take_earth_orientation(const SiteOptions &o) {
  return o.earth_orientation.empty() ? Result<void>()
                                     : use_earth_orientation_file(o.earth_orientation);
}

Result<Site> site_of(const SiteOptions &o) {
  if (!o.site.empty())
    return site_from(o.site);
  for (const auto *one : {o.latitude, o.longitude, o.altitude})
    if (one->count() == 0)
      return fail(ErrorCode::Usage,
                  "where? Give --site NAME or LAT,LON,ALT, or --lat-deg, --lon-deg and --alt-m");
  return make_site("", o.latitude_deg, o.longitude_deg, o.altitude_m);
}

} // namespace umov::cli
