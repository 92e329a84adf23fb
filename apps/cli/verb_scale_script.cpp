// umov scale script: a job in parts handed to a batch system.

#include "finishing.h"
#include "verb_scale.h"

#include <algorithm>
#include <filesystem>
#include <umov/scale/script.h>

namespace umov::cli {
namespace {

struct ScriptOptions {
  ScaleJobOptions job;
  scale::ScriptSettings settings;
  std::string system, output;
};

Result<void> write_script(ScriptOptions &o, const Common &common, Diagnostics &diagnostics) {
  scale::PlanSettings plan;
  plan.threads = o.settings.threads;
  plan.cores = o.settings.tasks * o.settings.threads;
  UMOV_ASSIGN(folder, folder_of(o.job, plan, common, diagnostics));
  std::error_code code;
  std::filesystem::create_directories(folder.path() / "log", code);
  o.settings.program = own_program();
  o.settings.tasks = std::min(o.settings.tasks, folder.lock().shards());
  // Twice what is predicted, as batch systems end what takes longer.
  const double predicted =
      3600 * scale::plan_of(folder.lock(), plan).core_hours / static_cast<double>(plan.cores);
  o.settings.wall_s = std::max(600.0, 2 * predicted);
  return put(o.output, o.system == "slurm" ? scale::slurm_script(folder, o.settings)
                                           : scale::condor_script(folder, o.settings));
}

} // namespace

void add_scale_script(CLI::App &scale, const Exit &exit_with) {
  auto *verb = scale.add_subcommand(
      "script", "An array job for a batch system, which needs nothing but umov");
  auto o = std::make_shared<ScriptOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("system", o->system, "slurm or condor")
      ->required()
      ->check(CLI::IsMember({"slurm", "condor"}));
  add_scale_job(*verb, o->job);
  verb->add_option("--tasks", o->settings.tasks, "Of the array")->check(CLI::Range(1, 100'000));
  verb->add_option("--threads", o->settings.threads, "Of each task")->check(CLI::Range(1, 1024));
  verb->add_option("--memory-mb", o->settings.memory_mb, "Of each task")
      ->check(CLI::Range(100, 10'000'000))
      ->capture_default_str();
  verb->add_option("--partition", o->settings.partition, "Of SLURM");
  verb->add_option("-o,--output", o->output, "File of the script, instead of stdout");
  o->settings.tasks = 10;
  add_common(*verb, *common, false);
  verb->callback(stoppable(exit_with, common, [=](Diagnostics &diagnostics) {
    take_arguments(*verb, o->job);
    return write_script(*o, *common, diagnostics);
  }));
}

} // namespace umov::cli
