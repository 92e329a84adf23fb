#include "console.h"
#include "verbs.h"

#include <umov/io/scenario.h>

namespace umov::cli {

void add_schema(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("schema", "JSON Schema of the scenario file, with all defaults");
  auto output = std::make_shared<std::string>();
  verb->add_option("-o,--output", *output, "File instead of stdout");
  verb->callback([output, exit_with] {
    const auto done = put(*output, scenario_schema_json());
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
