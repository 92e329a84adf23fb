#include "folder_options.h"

#include "tables.h"

#include <algorithm>
#include <umov/io/run_folder.h>

namespace umov::cli {

Result<void> take_folder(Scenario &scenario, const std::string &output,
                         const std::vector<std::string> &overrides) {
  UMOV_TRY(check_folder_name(output));
  if (!output.empty()) {
    scenario.output_dir = output;
    return {};
  }
  const bool is_named = std::ranges::any_of(
      overrides, [](const std::string &one) { return one.starts_with("output"); });
  return is_named ? Result<void>()
                  : RunFolder::check_named_by_file(scenario.output_dir, scenario.file);
}

} // namespace umov::cli
