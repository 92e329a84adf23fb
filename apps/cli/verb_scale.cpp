// umov scale: jobs in parts, on one machine or many.

#include "verb_scale.h"
#include "finishing.h"

#include "job_console.h"

#include <umov/core/parallel.h>

namespace umov::cli {
namespace {

struct PlanOptions {
  ScaleJobOptions job;
  scale::PlanSettings settings;
};

Result<void> plan(const PlanOptions &o, const Common &common, Diagnostics &diagnostics) {
  scale::JobLock lock;
  if (o.job.verb.empty()) {
    UMOV_ASSIGN(folder, scale::JobFolder::open(o.job.folder));
    UMOV_TRY(refuse_others(o.job, folder.lock()));
    lock = folder.lock();
  } else {
    std::unique_ptr<jobs::RangedJob> job;
    UMOV_ASSIGN(measured, measured_job(o.job, o.settings, common, diagnostics, job));
    lock = std::move(measured);
  }
  const scale::Plan plan = scale::plan_of(lock, o.settings);
  return put("", common.json ? scale::to_json(plan) : scale::describe(plan, lock.unit) + "\n");
}

void add_scale_plan(CLI::App &scale, const Exit &exit_with, bool begins) {
  auto *verb = begins ? scale.add_subcommand("lock", "Begin a job: make its folder, start nothing")
                      : scale.add_subcommand("plan", "What a job will cost; nothing is written");
  auto o = std::make_shared<PlanOptions>();
  auto common = std::make_shared<Common>();
  add_scale_job(*verb, o->job);
  verb->add_option("--cores", o->settings.cores, "Cores that will be at work")
      ->check(CLI::Range(1, 10'000'000));
  add_common(*verb, *common, true);
  o->settings.cores = resolve_threads(0);
  verb->callback(stoppable(exit_with, common, [=](Diagnostics &diagnostics) -> Result<void> {
    take_arguments(*verb, o->job);
    if (!begins)
      return plan(*o, *common, diagnostics);
    UMOV_ASSIGN(folder, folder_of(o->job, o->settings, *common, diagnostics));
    return common->json ? put("", scale::to_json(scale::plan_of(folder.lock(), o->settings)))
                        : Result<void>();
  }));
}

} // namespace

void add_scale_job(CLI::App &scale, ScaleJobOptions &o) {
  scale.prefix_command();
  scale.add_option("folder", o.folder, "Folder of the job")->required();
  scale.add_option("verb", o.verb,
                   "To begin a job: signature, passes, run, observe, invert pose or "
                   "identify, with its own arguments behind it");
  scale
      .add_option("--per-shard", o.per_shard,
                  "Poses, objects, passes, exposures or curves of a shard; by default what takes "
                  "10 to 120 s")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 40));
  scale
      .add_option("--isa", o.instruction_set,
                  "Instruction set that all machines have, for the same bytes on unlike ones; "
                  "default: the best of this one")
      ->check(CLI::IsMember({"avx512", "avx2", "sse4", "baseline"}));
  scale
      .add_option(
          "--reduce", o.reductions,
          "Keep this in place of the rows: histogram:COLUMN:LOW:HIGH:BINS, log-histogram:..., "
          "most:COLUMN:COUNT, least:COLUMN:COUNT, likelihood:COLUMN:VALUE:ERROR or "
          "likelihood:COLUMN+COLUMN:VALUE+VALUE:ERROR+ERROR; of each band, or of each value of the "
          "columns in :BY+BY behind it. May be given several times")
      ->take_all()
      ->allow_extra_args(false);
  scale.add_flag("--yes", o.may_cost_much, "Begin also above 100 core-h or 100 GB");
}

void take_arguments(const CLI::App &scale, ScaleJobOptions &o) { o.arguments = scale.remaining(); }

void add_scale(CLI::App &app, const Exit &exit_with) {
  auto *scale = app.add_subcommand(
      "scale", "Jobs in parts: many processes or machines, ended and taken up at will");
  scale->require_subcommand(1);
  scale->footer("umov scale run lib/hst signature hst.toml --poses 1000000 --phase 60\n"
                "umov scale merge lib/hst -o hst.fits");
  add_scale_plan(*scale, exit_with, false);
  add_scale_plan(*scale, exit_with, true);
  add_scale_run(*scale, exit_with);
  add_scale_status(*scale, exit_with);
  add_scale_merge(*scale, exit_with);
  add_scale_verify(*scale, exit_with);
  add_scale_script(*scale, exit_with);
  add_scale_worker(*scale, exit_with);
  add_scale_hold(*scale, exit_with);
}

} // namespace umov::cli
