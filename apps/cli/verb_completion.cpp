// umov completion, umov man: the command line told to shells and to man.

#include "completion.h"
#include "console.h"
#include "finishing.h"
#include "man_page.h"
#include "verbs.h"

namespace umov::cli {

void add_completion(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("completion", "Script with which a shell completes umov's verbs, "
                                                "options and their values");
  auto shell = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>();
  verb->add_option("shell", *shell, "Which shell")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  verb->add_option("-o,--output", *output, "File instead of stdout");
  verb->callback(finishing(exit_with, [&app, shell, output] {
    const VerbFacts root = facts_of(app);
    return put(*output, *shell == "bash"  ? bash_completion(root)
                        : *shell == "zsh" ? zsh_completion(root)
                                          : fish_completion(root));
  }));
}

void add_man(CLI::App &app, const Exit &exit_with) {
  auto *verb =
      app.add_subcommand("man", "The manual page umov.1; read it with umov man | man -l -");
  auto output = std::make_shared<std::string>();
  verb->add_option("-o,--output", *output, "File instead of stdout");
  verb->callback(
      finishing(exit_with, [&app, output] { return put(*output, man_page(facts_of(app))); }));
}

} // namespace umov::cli
