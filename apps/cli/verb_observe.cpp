#include "device_options.h"
#include "doubtful_elements.h"
#include "finishing.h"
#include "folder_options.h"
#include "job_console.h"
#include "scale_job.h"
#include "verbs.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>
#include <umov/jobs/observe.h>

namespace umov::cli {
namespace {

struct ObserveOptions {
  std::string scenario, output;
  std::vector<std::string> overrides;
  DoubtfulElements elements;
  PartOptions part;
};

/// The folder and what is in it, for programs.
void print_json(const jobs::Observation &made, const RunFolder &folder) {
  const nlohmann::ordered_json out{{"folder", folder.path().string()},
                                   {"exposures", made.exposures},
                                   {"saturated", made.saturated},
                                   {"rows", made.counts.rows()},
                                   {"frames", made.frames},
                                   {"left_out", made.left_out},
                                   {"light_s", made.light_s},
                                   {"counts_s", made.counts_s}};
  fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void tell_of(const jobs::Observation &made, const RunFolder &folder, const Common &common) {
  note(common, fmt::format("{}, {} rows of counts; light {:.1f} s, counts {:.1f} s",
                           counted(made.exposures, "exposure"), made.counts.rows(), made.light_s,
                           made.counts_s));
  for (const std::string &words : made.left_out)
    note(common, words);
  if (made.frames > 0)
    note(common, fmt::format("{} in frames/", counted(made.frames, "frame")));
  if (!common.quiet)
    fmt::print("written to {}\n", printable(folder.path().string()));
}

Result<void> run_observe(const ObserveOptions &o, const Common &common, Diagnostics &diagnostics) {
  const auto started = std::chrono::system_clock::now();
  UMOV_ASSIGN(scenario, read_scenario(o.scenario, o.overrides));
  UMOV_TRY(take_folder(scenario, o.output, o.overrides));
  UMOV_ASSIGN(folder, RunFolder::open(scenario.output_dir, common.force));
  jobs::JobOptions options = with_elements(job_options(common), o.elements);
  UMOV_ASSIGN(part, part_of(o.part));
  options.part = part;
  JobConsole console(common);
  jobs::FrameSink take_frame;
  if (scenario.observation && scenario.observation->makes_frames) {
    UMOV_ASSIGN(frames, folder.subfolder("frames"));
    take_frame = [frames](const std::string &name, const FitsImage &image) {
      return write_fits_image(frames / name, image);
    };
  }
  UMOV_ASSIGN(result, jobs::observe(scenario, options, console.monitor(common.verbose), diagnostics,
                                    take_frame));
  UMOV_TRY(jobs::write_observation(result, scenario, manifest_of_command(common, started),
                                   diagnostics, folder));
  if (common.json)
    print_json(result, folder);
  else
    tell_of(result, folder, common);
  return {};
}

void add_observe_options(CLI::App &verb, ObserveOptions &o, Common &common) {
  verb.add_option("scenario", o.scenario, "Scenario with [observation] and an instrument")
      ->required();
  verb.add_option("-o,--output", o.output, "Output folder, over the scenario's output.dir");
  verb.add_option("--set", o.overrides, "KEY=VALUE over a key of the scenario");
  add_part(verb, o.part, "exposures of all objects");
  verb.add_flag("--force", common.force, "Write into a folder that umov did not make");
  add_elements(verb, o.elements);
  verb.add_flag("-v,--verbose", common.verbose, "Also say what was read");
  add_device(verb, common);
  add_threads(verb, common);
  add_cache(verb, common);
  add_common(verb, common, true);
}

} // namespace

Result<RangedVerb> observe_in_parts(const std::vector<std::string> &arguments,
                                    const PartsSetting &setting, Diagnostics &diagnostics) {
  CLI::App verb("Counts of an instrument", "observe");
  ObserveOptions o;
  Common common;
  add_observe_options(verb, o, common);
  UMOV_TRY(parse_verb(verb, arguments));
  UMOV_TRY(refuse_output(o.output, o.part));
  UMOV_ASSIGN(scenario, read_scenario(o.scenario, o.overrides));
  jobs::JobOptions options = with_elements(setting.options, o.elements);
  options.device = device_options(common);
  UMOV_ASSIGN(
      job, jobs::ranged_observe(scenario, options, setting.layout, setting.monitor, diagnostics));
  return RangedVerb{std::move(job), ""};
}

void add_observe(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand(
      "observe", "Counts that an instrument records of a scenario: air, telescope, polarimeter");
  auto o = std::make_shared<ObserveOptions>();
  auto common = std::make_shared<Common>();
  add_observe_options(*verb, *o, *common);
  verb->callback(stoppable(exit_with, common, [o, common](Diagnostics &diagnostics) {
    return run_observe(*o, *common, diagnostics);
  }));
}

} // namespace umov::cli
