#include "console.h"
#include "finishing.h"
#include "verbs.h"

#include <umov/io/scenario.h>

namespace umov::cli {

void add_schema(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("schema", "JSON Schema of the scenario file, with all defaults");
  auto output = std::make_shared<std::string>();
  verb->add_option("-o,--output", *output, "File instead of stdout");
  verb->callback(finishing(exit_with, [output] { return put(*output, scenario_schema_json()); }));
}

} // namespace umov::cli
