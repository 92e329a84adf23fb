// umov scale verify, umov scale repair: whether what was written is still what is there.

#include "job_console.h"
#include "scale_folder_verb.h"

#include <umov/scale/merge.h>
#include <umov/scale/run_job.h>

namespace umov::cli {
namespace {

Result<void> check_files(const scale::JobFolder &folder, const Common &common) {
  JobConsole console(common);
  UMOV_ASSIGN(verdict, scale::verify(folder, console.monitor(false)));
  if (!verdict.is_whole())
    return fail(ErrorCode::BadInput, scale::describe(verdict, folder) + ". umov scale repair " +
                                         folder.path().string() + " makes them anew.");
  return put("", scale::describe(verdict, folder) + "\n");
}

Result<void> repair(const scale::JobFolder &folder, std::size_t memory_mb, const Common &common) {
  JobConsole console(common);
  const jobs::Monitor monitor = console.monitor(true);
  UMOV_ASSIGN(verdict, scale::verify(folder, monitor));
  scale::remove_bad(folder, verdict);
  note(common, scale::describe(verdict, folder));
  scale::RunSettings settings;
  settings.program = own_program();
  settings.memory_mb = memory_mb;
  UMOV_ASSIGN(tally, scale::run_job(folder, settings, monitor));
  if (tally.failed > 0)
    return fail(ErrorCode::BadInput, tally.failures.front().message,
                {(folder.path() / "failed").string()});
  return scale::write_manifest(folder);
}

} // namespace

void add_scale_verify(CLI::App &scale, const Exit &exit_with) {
  add_folder_verb(scale, exit_with, "verify", "Read all shards and compare them with their hashes",
                  false, check_files);
  auto memory_mb = std::make_shared<std::size_t>(0);
  add_folder_verb(scale, exit_with, "repair", "Remove damaged shards and do them again", false,
                  [memory_mb](const scale::JobFolder &folder, const Common &common) {
                    return repair(folder, *memory_mb, common);
                  })
      ->add_option("--memory-mb", *memory_mb,
                   "Of the process that does them; default: nine tenths of what is here")
      ->check(CLI::Range(64, 1'000'000'000));
}

} // namespace umov::cli
