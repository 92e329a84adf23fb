// umov scale hold: the folder of a job for drivers that are not this program.

#include "scale_folder_verb.h"

#include <cstdio>
#include <fmt/format.h>
#include <umov/scale/lease.h>
#include <umov/scale/merge.h>

namespace umov::cli {
namespace {

/// Keeps others out until the standard input ends.
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

} // namespace

void add_scale_hold(CLI::App &scale, const Exit &exit_with) {
  add_folder_verb(scale, exit_with, "hold",
                  "Hold the folder until the standard input ends, for a driver of another language",
                  false, hold);
}

} // namespace umov::cli
