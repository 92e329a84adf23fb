#pragma once
// What the command line says of a run, and the scenario that comes of it.

#include "doubtful_elements.h"
#include "part_options.h"

#include <umov/io/scenario.h>

namespace umov::cli {

/// Options of `umov run`.
struct RunOptions {
  std::string scenario, output, earth_orientation;
  std::vector<std::string> overrides;
  std::int64_t seed = -1;
  double accuracy = 0;
  bool dry_run = false;
  DoubtfulElements elements;
  PartOptions part;
};

void add_run_options(CLI::App &verb, RunOptions &o, Common &common);
/// The scenario file with the options over it, complete for a run.
Result<Scenario> scenario_of(const RunOptions &o);

} // namespace umov::cli
