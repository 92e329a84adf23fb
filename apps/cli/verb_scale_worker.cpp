// umov scale worker: the process that umov scale run starts for shards.

#include "job_console.h"
#include "verb_scale.h"

#include <csignal>
#include <filesystem>
#include <new>
#include <type_traits>
#include <umov/light/instruction_set.h>
#include <umov/scale/shard_work.h>

namespace umov::cli {
namespace {

/// A job that is too large to be made ready has no shard at all: who asks is to hear it, or would
/// try each of them.
template <class Make> std::invoke_result_t<Make> within_memory(const Make &make) {
  try {
    return make();
  } catch (const std::bad_alloc &) {
    return fail(ErrorCode::Device,
                "the job needs more memory than its process may have: fewer --workers, or "
                "--memory-mb, give each more");
  }
}

/// The job of a folder, made ready where it was begun.
Result<void> work(const std::string &path, const Common &common) {
  UMOV_ASSIGN(folder, scale::JobFolder::open(path));
  const scale::JobLock &lock = folder.lock();
  if (!lock.instruction_set.empty() && !restrict_engine(lock.instruction_set))
    return fail(ErrorCode::Device, "this machine, or what was built for it, has no " +
                                       lock.instruction_set +
                                       ", which the job is held to. Leave it out.");
  std::error_code code;
  std::filesystem::current_path(lock.directory, code);
  if (code)
    return fail(ErrorCode::BadInput,
                "the job was begun here, and its files are looked for from here: " + code.message(),
                {lock.directory});
  PartsSetting parts;
  parts.options = job_options(common);
  parts.options.mask_cache = folder.path() / "masks";
  parts.layout = lock.layout;
  parts.reductions = lock.reductions;
  parts.monitor.cancel = &scale::parent_has_left();
  Diagnostics told_at_the_begin;
  UMOV_ASSIGN(job, within_memory([&] {
                return verb_in_parts(lock.verb, lock.arguments, parts, told_at_the_begin);
              }));
  UMOV_TRY(scale::check_same_job(folder, *job));
  return within_memory([&] { return scale::serve_shards(folder, *job); }); // masks, when kept
}

/// The exit code; who asks for shards hears why there are none.
int code_of(const Result<void> &done) {
  if (done)
    return 0;
  if (done.error().code == ErrorCode::Interrupted) // as who asked has left
    return static_cast<int>(ErrorCode::Interrupted);
  scale::refuse_shards(done.error());
  return report(done.error());
}

} // namespace

void add_scale_worker(CLI::App &scale, const Exit &exit_with) {
  auto *verb = scale.add_subcommand(
      "worker", "Shards whose numbers come line by line on the standard input; a record of each");
  auto folder = std::make_shared<std::string>();
  auto common = std::make_shared<Common>();
  auto memory_mb = std::make_shared<std::size_t>(0);
  verb->add_option("folder", *folder, "Folder of the job")->required();
  verb->add_option("--memory-mb", *memory_mb,
                   "Of this process; default: nine tenths of what is here")
      ->check(CLI::Range(64, 1'000'000'000));
  add_threads(*verb, *common);
  add_common(*verb, *common, false);
  verb->callback([=] {
    std::signal(SIGINT, SIG_IGN); // who started it says when it ends
    scale::hold_to_memory(*memory_mb);
    exit_with(code_of(work(*folder, *common)));
  });
}

} // namespace umov::cli
