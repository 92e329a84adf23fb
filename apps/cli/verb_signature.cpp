#include "device_options.h"
#include "finishing.h"
#include "job_console.h"
#include "scale_job.h"
#include "signature_files.h"
#include "signature_options.h"
#include "tables.h"
#include "verbs.h"

#include <umov/core/journal.h>
#include <umov/jobs/ranged_job.h>

namespace umov::cli {
namespace {

Result<void> run_signature(const SignatureOptions &o, const Common &common,
                           Diagnostics &diagnostics) {
  UMOV_TRY(check_output(o.output));
  UMOV_TRY(check_mask_file(o.masks));
  UMOV_ASSIGN(part, part_of(o.part));
  UMOV_ASSIGN(scenario, read_scenario(o.scene, o.overrides));
  UMOV_ASSIGN(poses, poses_of(o, scenario));
  UMOV_ASSIGN(range, part.of(poses.count, "poses"));
  UMOV_TRY(tell_size(o.output, range.count * scenario.bands.size(), common));
  JobConsole console(common, tracing_masks);
  const auto sink = sink_for(o.output, common);
  jobs::JobOptions options = job_options(common);
  options.journal = Journal::name_for(o.output);
  options.part = part;
  return jobs::signature(scenario, poses, request_of(o), *sink, options, console.monitor(true),
                         diagnostics);
}

} // namespace

Result<RangedVerb> signature_in_parts(const std::vector<std::string> &arguments,
                                      const PartsSetting &setting, Diagnostics &diagnostics) {
  CLI::App verb("Stokes of an object for directions", "signature");
  SignatureOptions o;
  Common common;
  add_signature_options(verb, o, common);
  UMOV_TRY(parse_verb(verb, arguments));
  UMOV_TRY(check_directions(o));
  UMOV_TRY(refuse_output(o.output, o.part));
  UMOV_ASSIGN(scenario, read_scenario(o.scene, o.overrides));
  UMOV_ASSIGN(poses, poses_of(o, scenario));
  jobs::JobOptions options = setting.options;
  options.device = device_options(common);
  UMOV_ASSIGN(job, jobs::ranged_signature(scenario, poses, request_of(o), options, setting.monitor,
                                          diagnostics));
  return RangedVerb{std::move(job), ""};
}

void add_signature(CLI::App &app, const Exit &exit_with) {
  auto *verb =
      app.add_subcommand("signature", "Stokes of an object for directions, without an orbit");
  auto o = std::make_shared<SignatureOptions>();
  auto common = std::make_shared<Common>();
  verb->footer(
      "With -o FILE and ended early, by Ctrl-C or a kill, the same command goes on where it "
      "was: finished rows are kept in FILE.rows.partial until the table is complete.");
  add_signature_options(*verb, *o, *common);
  verb->callback(
      stoppable(exit_with, common, [o, common](Diagnostics &diagnostics) -> Result<void> {
        UMOV_TRY(check_directions(*o));
        return run_signature(*o, *common, diagnostics);
      }));
}

} // namespace umov::cli
