#include "finishing.h"
#include "tables.h"
#include "verbs.h"

#include <umov/io/observation.h>
#include <umov/jobs/exposure.h>

namespace umov::cli {
namespace {

Result<void> list(const std::string &output, const Common &common) {
  UMOV_ASSIGN(table, jobs::instrument_list());
  return put_table(output, table, common);
}

Result<void> show(const std::string &name, const std::string &output) {
  UMOV_ASSIGN(one, read_instrument(name));
  return put(output, instrument_as_toml(one));
}

} // namespace

void add_instrument(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("instrument", "Telescopes with their polarimeters, as files");
  verb->require_subcommand(1);
  auto common = std::make_shared<Common>();
  auto output = std::make_shared<std::string>();
  auto name = std::make_shared<std::string>();
  auto *listed = verb->add_subcommand("list", "Instruments that are compiled in");
  add_table_output(*listed, *output);
  add_common(*listed, *common, true);
  listed->callback(finishing(exit_with, [=] { return list(*output, *common); }));
  auto *shown = verb->add_subcommand("show", "An instrument as TOML, to be changed and named");
  shown->add_option("name", *name, "Name or file")->required();
  shown->add_option("-o,--output", *output, "TOML file; default: stdout");
  shown->callback(finishing(exit_with, [=] { return show(*name, *output); }));
}

} // namespace umov::cli
