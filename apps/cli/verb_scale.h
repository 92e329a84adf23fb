#pragma once
// Private to the verbs of `umov scale`.

#include "scale_job.h"
#include "verbs.h"

#include <umov/scale/plan.h>

namespace umov::cli {

/// A folder, and where it is to be made the verb whose job it is for.
struct ScaleJobOptions {
  std::string folder, verb, instruction_set;
  std::vector<std::string> arguments;  ///< of the verb
  std::vector<std::string> reductions; ///< umov/scale/reduction.h
  std::size_t per_shard = 0;
  bool may_cost_much = false;
};
/// FOLDER, and VERB with its arguments behind all options.
void add_scale_job(CLI::App &scale, ScaleJobOptions &o);
/// What stands behind VERB.
void take_arguments(const CLI::App &scale, ScaleJobOptions &o);

/// Where umov itself is.
std::string own_program();
/// The job of the options as it would be locked; nothing is written.
Result<scale::JobLock> measured_job(const ScaleJobOptions &o, const scale::PlanSettings &settings,
                                    const Common &common, Diagnostics &diagnostics,
                                    std::unique_ptr<jobs::RangedJob> &job);
/// Usage for --per-shard, --isa and (without a verb) --reduce that are not those of the job in the
/// folder.
Result<void> refuse_others(const ScaleJobOptions &o, const scale::JobLock &lock);
/// The folder of the options: that of a job which is there, or one begun anew, when its cost has
/// been told and is not too much.
Result<scale::JobFolder> folder_of(const ScaleJobOptions &o, const scale::PlanSettings &settings,
                                   const Common &common, Diagnostics &diagnostics);

void add_scale_run(CLI::App &scale, const Exit &exit_with);
void add_scale_worker(CLI::App &scale, const Exit &exit_with);
void add_scale_hold(CLI::App &scale, const Exit &exit_with);
void add_scale_merge(CLI::App &scale, const Exit &exit_with);
void add_scale_status(CLI::App &scale, const Exit &exit_with);
void add_scale_verify(CLI::App &scale, const Exit &exit_with);
void add_scale_script(CLI::App &scale, const Exit &exit_with);

} // namespace umov::cli
