#pragma once
#include "console.h"

#include <CLI/CLI.hpp>
#include <string>
#include <umov/frames/site.h>
#include <umov/time/epoch.h>

namespace umov::cli {

/// Where the observer stands: a site by name or by three numbers; how the Earth turns under it.
struct SiteOptions {
  std::string site, earth_orientation;
  double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;
  CLI::Option *latitude = nullptr, *longitude = nullptr, *altitude = nullptr;
};
void add_site(CLI::App &verb, SiteOptions &options);

/// A table of Earth orientation in place of the compiled-in one.
void add_earth_orientation(CLI::App &verb, std::string &file);
/// Takes that table for this process, where one is given.
Result<void> take_earth_orientation(const SiteOptions &options);

/// Usage where nothing, or not all of it, is said. A height that is not said is 0, with a remark.
Result<Site> site_of(const SiteOptions &options, const Common &common);

/// A time as options take it: ISO 8601, or a date alone for 0 h UTC of that day. A message begins
/// with the name of the option.
Result<Epoch<Utc>> time_of(const char *option, const std::string &text);

} // namespace umov::cli
