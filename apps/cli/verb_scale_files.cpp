// What is done with the folder of a job in parts: status, merge, verify, repair, scripts.

#include "job_console.h"
#include "tables.h"
#include "verb_scale.h"

#include <filesystem>
#include <fmt/format.h>
#include <umov/scale/lease.h>
#include <umov/scale/merge.h>
#include <umov/scale/run_job.h>
#include <umov/scale/script.h>

namespace umov::cli {
namespace {

namespace fs = std::filesystem;

/// Adds a verb on a folder alone.
template <class Do>
CLI::App *add_folder_verb(CLI::App &scale, const Exit &exit_with, const char *name,
                          const char *text, bool prints, Do what) {
  auto *verb = scale.add_subcommand(name, text);
  auto path = std::make_shared<std::string>();
  auto common = std::make_shared<Common>();
  verb->add_option("folder", *path, "Folder of the job")->required();
  add_common(*verb, *common, prints);
  verb->callback([=] {
    watch_interrupts();
    const auto folder = scale::JobFolder::open(*path);
    const auto done =
        folder ? what(*folder, *common) : Result<void>(tl::unexpected(folder.error()));
    exit_with(done ? 0 : report(done.error()));
  });
  return verb;
}

Result<void> tell_status(const scale::JobFolder &folder, const Common &common) {
  UMOV_ASSIGN(there, folder.shards());
  const std::size_t all = folder.lock().shards();
  const auto failed = folder.failed();
  std::size_t bytes = 0;
  std::error_code unknown;
  for (const auto &[index, files] : there)
    for (const scale::Shard &shard : files)
      if (const auto size = fs::file_size(folder.file_of(shard), unknown); !unknown)
        bytes += size;
  const std::string holders = scale::lease_holders(folder.path());
  if (common.json)
    return put("", fmt::format("{{\"shards\": {}, \"done\": {}, \"failed\": {}, \"bytes\": {}, "
                               "\"total\": {}, \"unit\": \"{}\", \"is_complete\": {}, "
                               "\"is_held\": {}}}\n",
                               all, there.size(), failed.size(), bytes, folder.lock().total,
                               folder.lock().unit, there.size() == all, !holders.empty()));
  std::string text =
      fmt::format("{} of {} shards are done ({} {} in all), {:.3g} GB\n", there.size(), all,
                  folder.lock().total, folder.lock().unit, static_cast<double>(bytes) / 1e9);
  for (const scale::FailedShard &one : failed)
    text += fmt::format("shard {} failed ({}, tried {} times): {}\n", one.index, one.code,
                        one.attempts, one.message);
  text += holders.empty() ? "nobody is at work\n" : "at work: " + holders + "\n";
  return put("", text);
}

Result<void> check_files(const scale::JobFolder &folder, const Common &common) {
  JobConsole console(common);
  UMOV_ASSIGN(verdict, scale::verify(folder, console.monitor(false)));
  if (!verdict.is_whole())
    return fail(ErrorCode::BadInput, scale::describe(verdict, folder) + ". umov scale repair " +
                                         folder.path().string() + " makes them anew.");
  return put("", scale::describe(verdict, folder) + "\n");
}

Result<void> repair(const scale::JobFolder &folder, const Common &common) {
  JobConsole console(common);
  const jobs::Monitor monitor = console.monitor(true);
  UMOV_ASSIGN(verdict, scale::verify(folder, monitor));
  scale::remove_bad(folder, verdict);
  note(common, scale::describe(verdict, folder));
  scale::RunSettings settings;
  settings.program = own_program();
  UMOV_ASSIGN(tally, scale::run_job(folder, settings, monitor));
  if (tally.failed > 0)
    return fail(ErrorCode::BadInput, tally.failures.front().message,
                {(folder.path() / "failed").string()});
  return scale::write_manifest(folder);
}

/// Keeps others out until the standard input ends: for drivers that are not this program.
Result<void> hold(const scale::JobFolder &folder, const Common & /*common*/) {
  UMOV_ASSIGN(lease, scale::Lease::take(folder.path(), ""));
  (void)lease; // held as long as it lives
  folder.sweep();
  fmt::print("held\n");
  UMOV_TRY(flush_output());
  while (std::getchar() != EOF) {
  }
  folder.sweep();
  UMOV_ASSIGN(there, folder.shards());
  return there.size() == folder.lock().shards() ? scale::write_manifest(folder) : Result<void>();
}

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
  fs::create_directories(folder.path() / "log", code);
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

void add_scale_status(CLI::App &scale, const Exit &exit_with) {
  add_folder_verb(scale, exit_with, "status", "What is done of a job, what failed, who is at it",
                  true, tell_status);
}

void add_scale_verify(CLI::App &scale, const Exit &exit_with) {
  add_folder_verb(scale, exit_with, "verify", "Read all shards and compare them with their hashes",
                  false, check_files);
  add_folder_verb(scale, exit_with, "repair", "Remove damaged shards and do them again", false,
                  repair);
}

void add_scale_hold(CLI::App &scale, const Exit &exit_with) {
  add_folder_verb(scale, exit_with, "hold",
                  "Hold the folder until the standard input ends, for a driver of another language",
                  false, hold);
}

void add_scale_merge(CLI::App &scale, const Exit &exit_with) {
  auto output = std::make_shared<std::string>(), table = std::make_shared<std::string>();
  auto *verb = add_folder_verb(
      scale, exit_with, "merge", "The table that the plain command would have written", false,
      [=](const scale::JobFolder &folder, const Common &common) -> Result<void> {
        UMOV_TRY(check_output(*output));
        JobConsole console(common);
        const auto sink = sink_for(*output, common);
        return scale::merge(folder, table->empty() ? folder.lock().tables.front() : *table, *sink,
                            console.monitor(false));
      });
  add_table_output(*verb, *output);
  verb->add_option("--table", *table, "Of a run: lightcurve (default) or passes");
}

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
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  verb->add_option("--partition", o->settings.partition, "Of SLURM");
  verb->add_option("-o,--output", o->output, "File of the script, instead of stdout");
  o->settings.tasks = 10;
  add_common(*verb, *common, false);
  verb->callback([=] {
    take_arguments(*verb, o->job);
    watch_interrupts();
    Diagnostics diagnostics;
    const auto done = write_script(*o, *common, diagnostics);
    report(diagnostics, *common);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
