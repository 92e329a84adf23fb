#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <umov/frames/site.h>

namespace umov::cli {

/// Where the observer stands: a site by name or by three numbers.
struct SiteOptions {
  std::string site;
  double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;
  CLI::Option *latitude = nullptr, *longitude = nullptr, *altitude = nullptr;
};
void add_site(CLI::App &verb, SiteOptions &options);

/// Usage where nothing, or not all of it, is said.
Result<Site> site_of(const SiteOptions &options);

} // namespace umov::cli
