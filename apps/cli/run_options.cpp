#include "run_options.h"

#include "device_options.h"
#include "folder_options.h"
#include "site_options.h"

#include <fmt/format.h>

namespace umov::cli {

void add_run_options(CLI::App &verb, RunOptions &o, Common &common) {
  verb.add_option("scenario", o.scenario, "Scenario file (TOML); see umov schema")->required();
  verb.add_option("-o,--output", o.output, "Output folder, over the scenario's output.dir");
  verb.add_option("--set", o.overrides, "KEY=VALUE over a key of the scenario");
  verb.add_option("--seed", o.seed, "Over the scenario's seed")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 53));
  verb.add_option("--accuracy", o.accuracy, "Relative 95 % half-width asked of I")
      ->check(CLI::Range(1e-6, 1.0));
  add_device(verb, common);
  add_earth_orientation(verb, o.earth_orientation);
  add_part(verb, o.part, "passes of all objects");
  verb.add_flag("--dry-run", o.dry_run, "Read and check everything, compute nothing");
  verb.add_flag("--force", common.force, "Write into a folder that umov did not make");
  add_elements(verb, o.elements);
  verb.add_flag("-v,--verbose", common.verbose, "Also say what was read and how long it took");
  add_threads(verb, common);
  add_cache(verb, common);
  add_common(verb, common, true);
}

Result<Scenario> scenario_of(const RunOptions &o) {
  std::vector<std::string> overrides = o.overrides;
  if (o.seed >= 0)
    overrides.push_back(fmt::format("seed={}", o.seed));
  if (o.accuracy > 0)
    overrides.push_back(fmt::format("render.accuracy={:.17g}", o.accuracy));
  UMOV_ASSIGN(scenario, read_scenario(o.scenario, overrides));
  if (!o.earth_orientation.empty())
    scenario.earth_orientation = o.earth_orientation;
  UMOV_TRY(take_folder(scenario, o.output, o.overrides));
  UMOV_TRY(check_complete_for_run(scenario));
  UMOV_TRY(check_magnitudes(scenario));
  return scenario;
}

} // namespace umov::cli
