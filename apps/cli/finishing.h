#pragma once
// What a verb does when it is called: its work, what there is to tell of it, the exit code.

#include "console.h"
#include "verbs.h"

#include <functional>
#include <memory>

namespace umov::cli {

/// The end of the work is that of the program.
std::function<void()> finishing(Exit exit_with, std::function<Result<void>()> work);
/// The same; warnings are told when it is over, as `common` wants them.
std::function<void()> finishing(Exit exit_with, std::shared_ptr<const Common> common,
                                std::function<Result<void>(Diagnostics &)> work);
/// The same of work that looks at `interrupted()`, and so is left to end by itself at the first
/// Ctrl-C.
std::function<void()> stoppable(Exit exit_with, std::shared_ptr<const Common> common,
                                std::function<Result<void>(Diagnostics &)> work);

} // namespace umov::cli
