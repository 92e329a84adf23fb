// umov completion, umov man: the command line told to shells and to man.

#include "completion.h"
#include "console.h"
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
  verb->callback([&app, shell, output, exit_with] {
    const VerbFacts root = facts_of(app);
    const auto done = put(*output, *shell == "bash"  ? bash_completion(root)
                                   : *shell == "zsh" ? zsh_completion(root)
                                                     : fish_completion(root));
    exit_with(done ? 0 : report(done.error()));
  });
}

void add_man(CLI::App &app, const Exit &exit_with) {
  auto *verb =
      app.add_subcommand("man", "The manual page umov.1; read it with umov man | man -l -");
  auto output = std::make_shared<std::string>();
  verb->add_option("-o,--output", *output, "File instead of stdout");
  verb->callback([&app, output, exit_with] {
    const auto done = put(*output, man_page(facts_of(app)));
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
