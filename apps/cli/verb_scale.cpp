// umov scale: jobs in parts, on one machine or many.

#include "verb_scale.h"

#include "cache_folder.h"
#include "job_console.h"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <umov/core/files.h>
#include <umov/core/parallel.h>
#include <umov/light/engine.h>
#include <unistd.h>

namespace umov::cli {
namespace {

namespace fs = std::filesystem;

/// Above these somebody is asked first.
constexpr double many_core_hours = 100, many_gigabytes = 100;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Result<void> ask_about(const scale::Plan &plan, const ScaleJobOptions &o) {
  std::error_code code;
  const auto room = fs::space(fs::absolute(o.folder).parent_path(), code);
  if (!code && plan.gigabytes * 1e9 > static_cast<double>(room.available))
    return fail(ErrorCode::Device,
                fmt::format("about {:.2g} GB will be written, and {:.2g} GB are free. Choose "
                            "another disk, or ask for less.",
                            plan.gigabytes, static_cast<double>(room.available) / 1e9),
                {o.folder});
  if (o.may_cost_much || (plan.core_hours < many_core_hours && plan.gigabytes < many_gigabytes))
    return {};
  if (::isatty(STDIN_FILENO) != 0 && ::isatty(STDERR_FILENO) != 0) {
    fmt::print(stderr, "Begin? [y/N] ");
    std::string answer;
    std::getline(std::cin, answer);
    if (answer == "y" || answer == "Y")
      return {};
    return fail(ErrorCode::Interrupted, "not begun");
  }
  return fail(ErrorCode::Usage,
              fmt::format("{:.0f} core-h and {:.0f} GB: --yes says that so much is meant",
                          plan.core_hours, plan.gigabytes));
}

Result<void> hold_to(const std::string &instruction_set) {
  if (instruction_set.empty() || restrict_engine(instruction_set))
    return {};
  return fail(ErrorCode::Device, "this machine has no " + instruction_set +
                                     ". Leave it out of the job, or begin one with an --isa that "
                                     "all machines have.");
}

struct PlanOptions {
  ScaleJobOptions job;
  scale::PlanSettings settings;
};

Result<void> plan(const PlanOptions &o, const Common &common, Diagnostics &diagnostics) {
  scale::JobLock lock;
  if (o.job.verb.empty()) {
    UMOV_ASSIGN(folder, scale::JobFolder::open(o.job.folder));
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
  verb->callback([=] {
    take_arguments(*verb, o->job);
    watch_interrupts();
    Diagnostics diagnostics;
    auto done = Result<void>();
    if (!begins) {
      done = plan(*o, *common, diagnostics);
    } else if (auto folder = folder_of(o->job, o->settings, *common, diagnostics); !folder) {
      done = tl::unexpected(folder.error());
    } else if (common->json) {
      done = put("", scale::to_json(scale::plan_of(folder->lock(), o->settings)));
    }
    report(diagnostics, *common);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace

void add_scale_job(CLI::App &scale, ScaleJobOptions &o) {
  scale.prefix_command();
  scale.add_option("folder", o.folder, "Folder of the job")->required();
  scale.add_option("verb", o.verb,
                   "To begin a job: signature, passes or run, with its own arguments behind it");
  scale
      .add_option("--per-shard", o.per_shard,
                  "Poses, objects or passes of a shard; by default what takes 10 to 120 s")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 40));
  scale
      .add_option("--isa", o.instruction_set,
                  "Instruction set that all machines have, for the same bytes on unlike ones; "
                  "default: the best of this one")
      ->check(CLI::IsMember({"avx512", "avx2", "sse4", "baseline"}));
  scale.add_flag("--yes", o.may_cost_much, "Begin also above 100 core-h or 100 GB");
}

void take_arguments(const CLI::App &scale, ScaleJobOptions &o) { o.arguments = scale.remaining(); }

std::string own_program() {
  std::error_code code;
  const fs::path self = fs::read_symlink("/proc/self/exe", code);
  return code ? command_line().front() : self.string();
}

Result<scale::JobLock> measured_job(const ScaleJobOptions &o, const scale::PlanSettings &settings,
                                    const Common &common, Diagnostics &diagnostics,
                                    std::unique_ptr<jobs::RangedJob> &job) {
  UMOV_TRY(hold_to(o.instruction_set));
  PartsSetting parts;
  parts.options.threads = 1; // CPU seconds of a core are what is told
  parts.options.mask_cache = fs::absolute(o.folder) / "masks";
  note(common, "reading the job and measuring some of it ...");
  const double before = cpu_seconds();
  UMOV_ASSIGN(made, verb_in_parts(o.verb, o.arguments, parts, diagnostics));
  job = std::move(made);
  scale::JobLock out;
  out.verb = o.verb;
  out.arguments = o.arguments;
  out.directory = fs::current_path().string();
  out.instruction_set = o.instruction_set;
  out.identity = job->identity();
  out.unit = job->unit();
  out.total = job->total();
  out.layout = job->layout();
  out.tables = job->tables();
  out.order = job->order();
  jobs::Monitor monitor;
  monitor.cancel = &interrupted();
  UMOV_ASSIGN(rate, scale::measure(*job, cpu_seconds() - before, monitor));
  out.rate = rate;
  scale::PlanSettings wanted = settings;
  wanted.per_shard = o.per_shard;
  out.per_shard = scale::shard_length(*job, rate, wanted);
  return out;
}

Result<scale::JobFolder> folder_of(const ScaleJobOptions &o, const scale::PlanSettings &settings,
                                   const Common &common, Diagnostics &diagnostics) {
  const bool is_there = file_exists(fs::path(o.folder) / "job.json");
  if (o.verb.empty() || is_there) {
    UMOV_ASSIGN(folder, scale::JobFolder::open(o.folder));
    const bool is_same = o.verb == folder.lock().verb && o.arguments == folder.lock().arguments &&
                         (o.per_shard == 0 || o.per_shard == folder.lock().per_shard);
    if (o.verb.empty() || is_same)
      return std::move(folder);
  }
  std::unique_ptr<jobs::RangedJob> job;
  UMOV_ASSIGN(lock, measured_job(o, settings, common, diagnostics, job));
  const scale::Plan plan = scale::plan_of(lock, settings);
  note(common, scale::describe(plan, lock.unit));
  if (!is_there)
    UMOV_TRY(ask_about(plan, o));
  UMOV_ASSIGN(folder, scale::JobFolder::begin(o.folder, lock));
  UMOV_TRY(job->keep()); // masks that were traced already serve all workers
  return std::move(folder);
}

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
