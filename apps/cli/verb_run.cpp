#include "device_options.h"
#include "finishing.h"
#include "job_console.h"
#include "run_console.h"
#include "run_options.h"
#include "scale_job.h"
#include "verbs.h"

#include <umov/jobs/ranged_job.h>
#include <umov/jobs/run.h>
#include <umov/jobs/run_plan.h>

namespace umov::cli {
namespace {

/// Reads and checks everything; the output folder last, as nothing is written.
Result<void> check_alone(const RunOptions &o, const Scenario &scenario, const Common &common,
                         Diagnostics &diagnostics) {
  UMOV_ASSIGN(part, part_of(o.part));
  jobs::JobOptions options = with_elements(job_options(common), o.elements);
  options.part = part;
  JobConsole console(common, tracing_masks);
  const jobs::Monitor monitor = console.monitor(common.verbose);
  UMOV_ASSIGN(objects, jobs::load_run(scenario, options, monitor, diagnostics));
  if (!common.json)
    tell_of_objects(o.scenario, objects, common);
  UMOV_TRY(RunFolder::open(scenario.output_dir, common.force));
  if (!common.json)
    return {};
  UMOV_ASSIGN(plan, jobs::run_plan_json(std::move(objects), scenario, options, monitor));
  return put("", plan + "\n");
}

Result<void> run(const RunOptions &o, const Common &common, Diagnostics &diagnostics) {
  const auto started = std::chrono::system_clock::now();
  UMOV_ASSIGN(scenario, scenario_of(o));
  if (o.dry_run)
    return check_alone(o, scenario, common, diagnostics);
  UMOV_ASSIGN(folder, RunFolder::open(scenario.output_dir, common.force));
  jobs::JobOptions options = with_elements(job_options(common), o.elements);
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

} // namespace

Result<RangedVerb> run_in_parts(const std::vector<std::string> &arguments,
                                const PartsSetting &setting, Diagnostics &diagnostics) {
  CLI::App verb("Light curve of a scenario", "run");
  RunOptions o;
  Common common;
  add_run_options(verb, o, common);
  UMOV_TRY(parse_verb(verb, arguments));
  UMOV_TRY(refuse_output(o.output, o.part));
  o.output = "."; // nothing is written there: the rows go to the shards
  UMOV_ASSIGN(scenario, scenario_of(o));
  jobs::JobOptions options = with_elements(setting.options, o.elements);
  options.device = device_options(common);
  UMOV_ASSIGN(job,
              jobs::ranged_run(scenario, options, setting.layout, setting.monitor, diagnostics));
  return RangedVerb{std::move(job), scenario.earth_orientation.string()};
}

void add_run(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("run", "Light curve of a scenario: tables, report, manifest");
  auto o = std::make_shared<RunOptions>();
  auto common = std::make_shared<Common>();
  verb->footer("Ended early, by Ctrl-C or a kill, the same command goes on where it was: finished "
               "rows are kept beside the folder, in NAME.rows.partial, until the run is complete.");
  add_run_options(*verb, *o, *common);
  verb->callback(stoppable(exit_with, common, [o, common](Diagnostics &diagnostics) {
    return run(*o, *common, diagnostics);
  }));
}

} // namespace umov::cli
