#pragma once
// Verbs of `umov scale` that need the folder of a job and nothing else.

#include "finishing.h"
#include "verb_scale.h"

namespace umov::cli {

/// Adds one: `what` is called with the folder and the common options.
template <class Do>
CLI::App *add_folder_verb(CLI::App &scale, const Exit &exit_with, const char *name,
                          const char *text, bool prints, Do what) {
  auto *verb = scale.add_subcommand(name, text);
  auto path = std::make_shared<std::string>();
  auto common = std::make_shared<Common>();
  verb->add_option("folder", *path, "Folder of the job")->required();
  add_common(*verb, *common, prints);
  verb->callback(stoppable(exit_with, common, [=](Diagnostics &) -> Result<void> {
    UMOV_ASSIGN(folder, scale::JobFolder::open(*path));
    return what(folder, *common);
  }));
  return verb;
}
} // namespace umov::cli
