#pragma once
// What the command line says of a search for passes.

#include "doubtful_elements.h"
#include "part_options.h"
#include "site_options.h"

#include <umov/jobs/passes.h>

namespace umov::cli {

/// Options of `umov passes`.
struct PassesOptions {
  SiteOptions site;
  std::string orbit, output, start, stop, shadow = "ellipsoid", chart, order = "rise";
  std::string scene, body, material, band;
  std::vector<std::string> overrides, columns;
  std::vector<int> norad;
  double size_m = 1, altitude_min_deg = 10, sun_altitude_max_deg = -6;
  std::optional<double> magnitude_max;
  bool is_visible_only = false, keep_going = false;
  DoubtfulElements elements;
  PartOptions part;
};

void add_passes_options(CLI::App &verb, PassesOptions &o, Common &common);
/// What is asked for; the Earth turns from here on as the options say.
Result<jobs::PassesRequest> request_of(const PassesOptions &o, const Common &common);

} // namespace umov::cli
