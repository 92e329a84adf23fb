#include "finishing.h"

namespace umov::cli {

std::function<void()> finishing(Exit exit_with, std::function<Result<void>()> work) {
  return [exit_with = std::move(exit_with), work = std::move(work)] {
    const Result<void> done = work();
    exit_with(done ? 0 : report(done.error()));
  };
}

std::function<void()> finishing(Exit exit_with, std::shared_ptr<const Common> common,
                                std::function<Result<void>(Diagnostics &)> work) {
  return finishing(std::move(exit_with), [common = std::move(common), work = std::move(work)] {
    Diagnostics diagnostics;
    Result<void> done = work(diagnostics);
    report(diagnostics, *common);
    return done;
  });
}

std::function<void()> stoppable(Exit exit_with, std::shared_ptr<const Common> common,
                                std::function<Result<void>(Diagnostics &)> work) {
  return finishing(std::move(exit_with), std::move(common),
                   [work = std::move(work)](Diagnostics &diagnostics) {
                     watch_interrupts();
                     return work(diagnostics);
                   });
}

} // namespace umov::cli
