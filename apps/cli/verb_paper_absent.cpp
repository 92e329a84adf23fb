// umov paper, in a build without it.

#include "console.h"
#include "verbs.h"

namespace umov::cli {

void add_paper(CLI::App &app, const Exit &exit_with) {
  auto *verb =
      app.add_subcommand("paper", "The paper's figures and claims remade (not in this build)");
  verb->allow_extras();
  verb->callback([exit_with] {
    exit_with(
        report(Error{ErrorCode::Device,
                     "this build has not the paper's figures: ./demo and the wheel do without "
                     "them. In the project's folder tools/build adds them, in a few minutes.",
                     {}}));
  });
}

} // namespace umov::cli
