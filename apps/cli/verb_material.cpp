#include "console.h"
#include "tables.h"
#include "verbs.h"

#include <umov/surface/material.h>

namespace umov::cli {
namespace {

Result<void> list(const Common &common) {
  std::vector<std::string> names;
  std::vector<double> exponents, body;
  for (const std::string &name : builtin_material_names()) {
    UMOV_ASSIGN(material, builtin_material(name));
    names.push_back(name);
    exponents.push_back(material.exponent);
    body.push_back(material.body ? material.body->reflectance.front() : 0);
  }
  Table table;
  table.add("material", "", "name", std::move(names));
  table.add("m", "", "Blinn-Phong exponent", std::move(exponents));
  table.add("r_sub", "", "reflectance below the surface, at the first wavelength", std::move(body));
  return put_table("", table, common);
}

} // namespace

void add_material(CLI::App &app, const Exit &exit_with) {
  auto *material = app.add_subcommand("material", "Materials that umov knows");
  material->require_subcommand(1);
  auto *verb = material->add_subcommand("list", "Names of the built-in materials");
  auto common = std::make_shared<Common>();
  add_common(*verb, *common, true);
  verb->callback([common, exit_with] {
    const auto done = list(*common);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
