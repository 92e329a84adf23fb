#include "tables.h"
#include "verbs.h"

#include <fmt/format.h>
#include <umov/io/observation.h>

namespace umov::cli {
namespace {

Result<void> list(const std::string &output, const Common &common) {
  std::vector<std::string> names, types, texts;
  std::vector<double> apertures;
  for (const std::string &name : instrument_names()) {
    UMOV_ASSIGN(one, read_instrument(name));
    names.push_back(name);
    apertures.push_back(one.telescope.aperture_m);
    types.emplace_back(name_of(one.polarimeter.type));
    texts.push_back(one.description);
  }
  Table table;
  table.add("name", "", "of the instrument", std::move(names));
  table.add("aperture", "m", "diameter", std::move(apertures));
  table.add("polarimeter", "", "type", std::move(types));
  table.add("description", "", "what it is", std::move(texts));
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
  listed->callback([=] {
    const auto done = list(*output, *common);
    exit_with(done ? 0 : report(done.error()));
  });
  auto *shown = verb->add_subcommand("show", "An instrument as TOML, to be changed and named");
  shown->add_option("name", *name, "Name or file")->required();
  shown->add_option("-o,--output", *output, "TOML file; default: stdout");
  shown->callback([=] {
    const auto done = show(*name, *output);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
