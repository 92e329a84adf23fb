#include "site_options.h"

#include <fmt/format.h>
#include <umov/io/sites.h>
#include <umov/time/earth_orientation.h>
#include <umov/time/typed.h>

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

Result<Site> site_of(const SiteOptions &o, const Common &common) {
  constexpr const char *no_height = "no height was given: 0 m above the WGS 84 ellipsoid is taken";
  if (!o.site.empty()) {
    UMOV_ASSIGN(site, site_from(o.site));
    if (std::count(o.site.begin(), o.site.end(), ',') == 1)
      note(common, fmt::format("{}; --site {},HEIGHT tells it", no_height, o.site));
    return site;
  }
  for (const auto *one : {o.latitude, o.longitude})
    if (one->count() == 0)
      return fail(ErrorCode::Usage,
                  "where? Give --site NAME or LAT,LON,ALT, or --lat-deg, --lon-deg and --alt-m");
  if (o.altitude->count() == 0)
    note(common, fmt::format("{}; --alt-m tells it", no_height));
  return make_site("", o.latitude_deg, o.longitude_deg, o.altitude_m);
}

Result<Epoch<Utc>> time_of(const char *option, const std::string &text) {
  auto time = utc_from_iso_or_day(text);
  if (!time)
    return fail(ErrorCode::BadInput, fmt::format("{} {}", option, time.error().message));
  return time;
}

} // namespace umov::cli
