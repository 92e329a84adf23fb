// How a job in parts begins: what it is, what it will cost, where it goes on.

#include "verb_scale.h"

#include "job_console.h"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iostream>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/light/instruction_set.h>
#include <umov/scale/reduction.h>
#include <unistd.h>

namespace umov::cli {
namespace {

namespace fs = std::filesystem;

/// Above these somebody is asked first.
constexpr double many_core_hours = 100, many_gigabytes = 100;
/// More than is stored as it is: what is wanted of it is made with it.
constexpr double too_many_gigabytes = 1000;

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
              fmt::format("{:.0f} core-h and {:.0f} GB: --yes says that so much is meant{}",
                          plan.core_hours, plan.gigabytes,
                          plan.gigabytes < too_many_gigabytes
                              ? ""
                              : "; --reduce keeps histograms or extremes in place of all rows"));
}

Result<void> hold_to(const std::string &instruction_set) {
  if (instruction_set.empty() || restrict_engine(instruction_set))
    return {};
  return fail(ErrorCode::Device, "this machine, or what was built for it, has no " +
                                     instruction_set +
                                     ". Leave it out of the job, or begin one with an --isa that "
                                     "all machines have.");
}

} // namespace

Result<void> refuse_others(const ScaleJobOptions &o, const scale::JobLock &lock) {
  const auto refuse = [](const std::string &given, const std::string &kept) {
    return fail(ErrorCode::Usage, fmt::format("{}: the job of the folder {}, as was said when it "
                                              "was begun. Leave it out, or begin another in a new "
                                              "folder",
                                              given, kept));
  };
  if (o.per_shard != 0 && std::min(o.per_shard, lock.total) != lock.per_shard)
    return refuse(fmt::format("--per-shard {}", o.per_shard),
                  fmt::format("has {} {} in a shard", lock.per_shard, lock.unit));
  if (!o.instruction_set.empty() && o.instruction_set != lock.instruction_set)
    return refuse("--isa " + o.instruction_set, lock.instruction_set.empty()
                                                    ? "is held to no instruction set"
                                                    : "is held to " + lock.instruction_set);
  // With a verb the whole job is compared, and the first difference told.
  if (!o.verb.empty() || o.reductions.empty() || o.reductions == lock.reductions)
    return {};
  return refuse("--reduce " + printable(fmt::format("{}", fmt::join(o.reductions, ", "))),
                "keeps " + (lock.reductions.empty()
                                ? "all rows"
                                : fmt::format("{}", fmt::join(lock.reductions, ", "))));
}

std::string own_program() {
  std::error_code code;
  const fs::path self = fs::read_symlink("/proc/self/exe", code);
  return code ? command_line().front() : self.string();
}

Result<scale::JobLock> measured_job(const ScaleJobOptions &o, const scale::PlanSettings &settings,
                                    const Common &common, Diagnostics &diagnostics,
                                    std::unique_ptr<jobs::RangedJob> &job) {
  UMOV_TRY(hold_to(o.instruction_set));
  UMOV_TRY(scale::check_reductions(o.reductions));
  PartsSetting parts;
  parts.options.threads = 1; // CPU seconds of a core are what is told
  parts.options.mask_cache = fs::absolute(o.folder) / "masks";
  parts.monitor.cancel = &interrupted();
  parts.reductions = o.reductions;
  note(common, "reading the job and measuring some of it ...");
  const double before = cpu_seconds();
  UMOV_ASSIGN(made, verb_in_parts(o.verb, o.arguments, parts, diagnostics));
  job = std::move(made);
  scale::JobLock out;
  out.verb = o.verb;
  out.arguments = o.arguments;
  out.directory = fs::current_path().string();
  out.instruction_set = o.instruction_set;
  out.reductions = o.reductions;
  out.identity = job->identity();
  out.unit = job->unit();
  out.total = job->total();
  out.layout = job->layout();
  out.tables = job->tables();
  out.order = job->order();
  out.nothing = job->nothing();
  out.problems = job->problems();
  out.warnings = job->warnings();
  out.tallies = job->tallies();
  UMOV_ASSIGN(rate, scale::measure(*job, cpu_seconds() - before, parts.monitor));
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
    UMOV_TRY(refuse_others(o, folder.lock()));
    const bool is_same = o.verb == folder.lock().verb && o.arguments == folder.lock().arguments &&
                         o.reductions == folder.lock().reductions;
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

} // namespace umov::cli
