// umov scale status.

#include "scale_folder_verb.h"

#include <umov/scale/status.h>

namespace umov::cli {
namespace {

Result<void> tell_status(const scale::JobFolder &folder, const Common &common) {
  UMOV_ASSIGN(status, scale::status_of(folder));
  return put("", common.json ? scale::to_json(status) : scale::describe(status));
}

} // namespace

void add_scale_status(CLI::App &scale, const Exit &exit_with) {
  add_folder_verb(scale, exit_with, "status", "What is done of a job, what failed, who is at it",
                  true, tell_status);
}

} // namespace umov::cli
