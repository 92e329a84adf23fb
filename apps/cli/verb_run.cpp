#include "job_console.h"
#include "part_options.h"
#include "run_console.h"
#include "scale_job.h"
#include "site_options.h"
#include "tables.h"
#include "verbs.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/text.h>
#include <umov/jobs/ranged_job.h>
#include <umov/jobs/run.h>

namespace umov::cli {
namespace {

struct RunOptions {
  std::string scenario, output, earth_orientation, device = "auto";
  std::vector<std::string> overrides;
  std::int64_t seed = -1;
  double accuracy = 0;
  bool dry_run = false, allow_bad_checksum = false, allow_old_elements = false;
  PartOptions part;
};

/// A scenario may come from others: a folder that it names outside the working folder is made, but
/// what stands there is replaced only if the user names it too.
Result<void> check_folder_of_file(const Scenario &scenario) {
  namespace fs = std::filesystem;
  std::error_code code;
  const fs::path inside = fs::absolute(scenario.output_dir, code)
                              .lexically_normal()
                              .lexically_relative(fs::current_path(code));
  if (inside.empty() || *inside.begin() != ".." || !fs::exists(scenario.output_dir, code))
    return {};
  return fail(ErrorCode::BadInput,
              fmt::format("output.dir = \"{0}\" is outside the working folder and is there "
                          "already. To replace it name it yourself: -o {0}",
                          scenario.output_dir.string()),
              {scenario.file});
}

Result<Scenario> read_with_options(const RunOptions &o) {
  std::vector<std::string> overrides = o.overrides;
  if (o.seed >= 0)
    overrides.push_back(fmt::format("seed={}", o.seed));
  if (o.accuracy > 0)
    overrides.push_back(fmt::format("render.accuracy={:.17g}", o.accuracy));
  UMOV_ASSIGN(scenario, read_scenario(o.scenario, overrides));
  const bool is_named = !o.output.empty() || std::any_of(o.overrides.begin(), o.overrides.end(),
                                                         [](const std::string &one) {
                                                           return one.starts_with("output");
                                                         });
  if (!o.output.empty())
    scenario.output_dir = o.output;
  UMOV_TRY(check_folder_name(o.output));
  if (!o.earth_orientation.empty())
    scenario.earth_orientation = o.earth_orientation;
  if (!is_named)
    UMOV_TRY(check_folder_of_file(scenario));
  UMOV_TRY(check_complete_for_run(scenario));
  return scenario;
}

/// Reads and checks everything; the output folder last, as nothing is written.
Result<void> check_alone(const RunOptions &o, const Scenario &scenario, const Common &common,
                         Diagnostics &diagnostics) {
  jobs::JobOptions options = job_options(common);
  options.allow_bad_checksum = o.allow_bad_checksum;
  options.allow_old_elements = o.allow_old_elements;
  JobConsole console(common, tracing_masks);
  UMOV_ASSIGN(objects,
              jobs::load_run(scenario, options, console.monitor(common.verbose), diagnostics));
  tell_of_objects(o.scenario, objects, common);
  UMOV_TRY(RunFolder::open(scenario.output_dir, common.force));
  return {};
}

Result<void> run(const RunOptions &o, const Common &common, Diagnostics &diagnostics) {
  const auto started = std::chrono::system_clock::now();
  UMOV_ASSIGN(scenario, read_with_options(o));
  if (o.dry_run)
    return check_alone(o, scenario, common, diagnostics);
  UMOV_ASSIGN(folder, RunFolder::open(scenario.output_dir, common.force));
  jobs::JobOptions options = job_options(common);
  options.allow_bad_checksum = o.allow_bad_checksum;
  options.allow_old_elements = o.allow_old_elements;
  options.journal = folder.journal_path();
  UMOV_ASSIGN(part, part_of(o.part));
  options.part = part;
  JobConsole console(common, tracing_masks);
  const jobs::Monitor monitor = console.monitor(common.verbose);
  UMOV_ASSIGN(objects, jobs::load_run(scenario, options, monitor, diagnostics));
  tell_of_search(scenario, common);
  UMOV_ASSIGN(result,
              jobs::compute_run(std::move(objects), scenario, options, monitor, diagnostics));
  UMOV_TRY(jobs::write_run(result, scenario, options, manifest_of_command(common, started),
                           diagnostics, folder));
  tell_of_run(result, folder, started, common);
  if (!result.stopped)
    return {};
  Error kept = *result.stopped;
  kept.message +=
      sentence_end(kept.message) + " The finished rows are in " + folder.path().string() + ".";
  return tl::unexpected(kept);
}

void declare(CLI::App &verb, RunOptions &o, Common &common) {
  verb.add_option("scenario", o.scenario, "Scenario file (TOML); see umov schema")->required();
  verb.add_option("-o,--output", o.output, "Output folder, over the scenario's output.dir");
  verb.add_option("--set", o.overrides, "KEY=VALUE over a key of the scenario");
  verb.add_option("--seed", o.seed, "Over the scenario's seed")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 53));
  verb.add_option("--accuracy", o.accuracy, "Relative 95 % half-width asked of I")
      ->check(CLI::Range(1e-6, 1.0));
  verb.add_option("--device", o.device, fmt::format("{} or auto", fmt::join(device_names(), ", ")))
      ->capture_default_str();
  add_earth_orientation(verb, o.earth_orientation);
  add_part(verb, o.part, "passes of all objects");
  verb.add_flag("--dry-run", o.dry_run, "Read and check everything, compute nothing");
  verb.add_flag("--force", common.force, "Write into a folder that umov did not make");
  verb.add_flag("--allow-bad-checksum", o.allow_bad_checksum, "Read elements with a bad checksum");
  verb.add_flag("--allow-old-elements", o.allow_old_elements, "Take elements over 30 days old");
  verb.add_flag("-v,--verbose", common.verbose, "Also say what was read and how long it took");
  add_threads(verb, common);
  add_cache(verb, common);
  add_common(verb, common, true);
}

} // namespace

Result<RangedVerb> run_in_parts(const std::vector<std::string> &arguments,
                                const PartsSetting &setting, Diagnostics &diagnostics) {
  CLI::App verb("Light curve of a scenario", "run");
  RunOptions o;
  Common common;
  declare(verb, o, common);
  UMOV_TRY(parse_verb(verb, arguments));
  UMOV_TRY(refuse_output(o.output, o.part));
  o.output = "."; // nothing is written there: the rows go to the shards
  UMOV_ASSIGN(scenario, read_with_options(o));
  jobs::JobOptions options = setting.options;
  options.allow_bad_checksum = o.allow_bad_checksum;
  options.allow_old_elements = o.allow_old_elements;
  UMOV_ASSIGN(job, jobs::ranged_run(scenario, options, setting.layout, {}, diagnostics));
  return RangedVerb{std::move(job), scenario.earth_orientation.string()};
}

void add_run(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("run", "Light curve of a scenario: tables, report, manifest");
  auto o = std::make_shared<RunOptions>();
  auto common = std::make_shared<Common>();
  verb->footer("Ended early, by Ctrl-C or a kill, the same command goes on where it was: finished "
               "rows are kept beside the folder, in NAME.rows.partial, until the run is complete.");
  declare(*verb, *o, *common);
  verb->callback([o, common, exit_with] {
    if (o->device != "auto" &&
        std::ranges::find(device_names(), o->device) == device_names().end()) {
      exit_with(
          report(Error{ErrorCode::Device,
                       "--device " + o->device +
                           ": this build has no such device. Use --device cpu; see umov doctor.",
                       {}}));
      return;
    }
    watch_interrupts();
    Diagnostics diagnostics;
    const auto done = run(*o, *common, diagnostics);
    report(diagnostics, *common);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
