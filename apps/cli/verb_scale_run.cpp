// umov scale run.

#include "finishing.h"
#include "job_console.h"
#include "verb_scale.h"

#include <fmt/format.h>
#include <string>
#include <umov/core/files.h>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/scale/merge.h>
#include <umov/scale/run_job.h>
#include <unistd.h>
#include <vector>

namespace umov::cli {
namespace {

struct ScaleRunOptions {
  ScaleJobOptions job;
  scale::RunSettings settings;
  std::string part, cluster;
};

/// What Python says where the package is missing is of no use to whoever asked for a cluster.
constexpr const char *begin_dask = R"(import runpy, sys
try:
    import umov.scale
except ImportError as problem:
    sys.exit(print(f"error: --cluster takes Python with the package umov[scale] ({problem}). Install "
                   "it for python3; without it umov scale run works on this machine, and umov scale "
                   "script for a batch system.", file=sys.stderr) or 6)
runpy.run_module("umov.scale", run_name="__main__", alter_sys=True)
)";

/// Dask is Python's: the same folder, done by umov.scale.
Result<void> run_on_cluster(const ScaleRunOptions &o, const scale::JobFolder &folder,
                            const Common &common) {
  std::vector<std::string> words{"python3", "-c", begin_dask, "run", folder.path().string()};
  words.insert(words.end(), {"--cluster", o.cluster, "--program", own_program()});
  if (o.settings.threads > 0)
    words.insert(words.end(), {"--threads", std::to_string(o.settings.threads)});
  if (o.settings.timeout_s > 0)
    words.insert(words.end(), {"--timeout-s", fmt::format("{}", o.settings.timeout_s)});
  if (o.settings.memory_mb > 0)
    words.insert(words.end(), {"--memory-mb", std::to_string(o.settings.memory_mb)});
  if (o.settings.joins)
    words.emplace_back("--join");
  if (common.quiet)
    words.emplace_back("--quiet");
  std::vector<char *> given;
  for (std::string &word : words)
    given.push_back(word.data());
  given.push_back(nullptr);
  ::execvp(given.front(), given.data());
  return fail(ErrorCode::Device,
              "--cluster takes Python with the package umov[scale]; without it umov scale run "
              "works on this machine, and umov scale script for a batch system");
}

void tell(const scale::RunTally &tally, const scale::JobFolder &folder, const Common &common) {
  std::string text =
      fmt::format("{} of {} shards done, {} of them before; {:.1f} s of CPU",
                  tally.there_before + tally.done, tally.wanted, tally.there_before, tally.cpu_s);
  if (tally.by_others > 0)
    text += fmt::format("; others did {} meanwhile", tally.by_others);
  if (tally.failed == 0 && tally.wanted == folder.lock().shards())
    text +=
        fmt::format(". umov scale merge {} -o TABLE puts them together", folder.path().string());
  note(common, text);
}

Result<void> run_scale(ScaleRunOptions &o, const Common &common, Diagnostics &diagnostics) {
  if (!o.part.empty()) {
    auto part = jobs::JobPart::shard(o.part);
    if (!part)
      return fail(ErrorCode::Usage,
                  "--part " + o.part + ": K/N with K from 0 to N - 1 was expected, such as 0/8");
    o.settings.part = *part;
  }
  o.settings.threads = static_cast<std::size_t>(common.threads);
  o.settings.program = own_program();
  const std::size_t cores = resolve_threads(static_cast<unsigned>(common.threads));
  scale::PlanSettings plan;
  plan.cores = common.threads > 0 ? cores * o.settings.workers : cores;
  plan.threads = std::max<std::size_t>(1, plan.cores / o.settings.workers);
  UMOV_ASSIGN(folder, folder_of(o.job, plan, common, diagnostics));
  if (!o.cluster.empty())
    return run_on_cluster(o, folder, common);
  JobConsole console(common);
  const jobs::Monitor monitor = console.monitor(true);
  UMOV_ASSIGN(tally, scale::run_job(folder, o.settings, monitor));
  tell(tally, folder, common);
  if (tally.failed > 0) {
    const scale::FailedShard &first = tally.failures.front();
    return fail(ErrorCode::BadInput,
                fmt::format("{} could not be done; shard {}: {}. All of them stand in {}/failed; "
                            "umov scale run {} tries them again.",
                            counted(tally.failed, "shard"), first.index, first.message,
                            folder.path().string(), folder.path().string()));
  }
  if (!o.settings.part.is_whole())
    return {}; // a task of an array has done its shards; whoever has all of them tells of the rows
  // A manifest is there only where all shards are, and of a whole job nothing was done.
  if (tally.done > 0 || !file_exists(folder.path() / "manifest.json"))
    UMOV_TRY(scale::write_manifest(folder));
  return scale::check_answers(folder, monitor);
}

} // namespace

void add_scale_run(CLI::App &scale, const Exit &exit_with) {
  auto *verb = scale.add_subcommand(
      "run", "Do what is missing of a job; with a verb behind the folder, begin it");
  auto o = std::make_shared<ScaleRunOptions>();
  auto common = std::make_shared<Common>();
  verb->footer("Ended in any way, umov scale run FOLDER goes on where it was.");
  add_scale_job(*verb, o->job);
  auto *workers =
      verb->add_option("--workers", o->settings.workers,
                       "Processes at a time; one with all threads serves most jobs best")
          ->check(CLI::Range(1, 1024))
          ->capture_default_str();
  auto *part = verb->add_option(
      "--part", o->part,
      "K/N: of the shards the K-th of N shares, from 0, as a task of an array job");
  verb->add_flag("--join", o->settings.joins, "Take part in a job that another umov is at");
  verb->add_option("--timeout-s", o->settings.timeout_s,
                   "Of a shard; default: ten times what is predicted, at least 60")
      ->check(CLI::Range(0.1, 1e7));
  verb->add_option("--memory-mb", o->settings.memory_mb,
                   "Of each process; default: its share of nine tenths of what is here")
      ->check(CLI::Range(64, 1'000'000'000));
  verb->add_option("--cluster", o->cluster,
                   "local:N, or the address of a Dask scheduler; takes the Python package "
                   "umov[scale]")
      ->excludes(workers)
      ->excludes(part);
  add_threads(*verb, *common);
  add_common(*verb, *common, false);
  verb->callback(stoppable(exit_with, common, [=](Diagnostics &diagnostics) {
    take_arguments(*verb, o->job);
    return run_scale(*o, *common, diagnostics);
  }));
}

} // namespace umov::cli
