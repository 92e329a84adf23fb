#pragma once
// Private: readers of the parts of a scenario.

#include "io/scenario/node.h"
#include <umov/io/scenario.h>

namespace umov::scenario {

Result<AttitudeLaw> read_attitude(const Node &node);
/// One [material.NAME] table.
Result<Material> read_material_table(const Node &node, const std::string &name);
/// All [material.NAME] tables of a document.
Result<std::map<std::string, Material>> read_material_tables(const Node &top);
/// A material that a scenario names: its own, a built-in one or a TOML file.
Result<Material> find_material(const std::string &name, const Scenario &scenario);
/// TOML of one material table.
std::string material_toml(const Material &material);
/// TOML of an attitude, as an inline table.
std::string attitude_toml(const AttitudeLaw &law);
/// A TOML string with what must be escaped.
std::string quoted(const std::string &text);

} // namespace umov::scenario
