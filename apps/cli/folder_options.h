#pragma once
// Into which folder a verb writes: the user's word, or that of a scenario.

#include "console.h"

#include <umov/io/scenario.h>

namespace umov::cli {

/// Puts `output` (-o; "" for none) over the scenario's output.dir. What stands in a folder that
/// neither it nor one of the overrides (--set) names is not replaced outside the working folder.
Result<void> take_folder(Scenario &scenario, const std::string &output,
                         const std::vector<std::string> &overrides);

} // namespace umov::cli
