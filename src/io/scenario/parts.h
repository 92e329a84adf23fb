#pragma once
// Private: readers of the parts of a scenario.

#include "io/scenario/node.h"
#include <umov/io/scenario.h>

namespace umov::scenario {

/// [1, 2.5] with the fewest digits that read back as the same numbers.
std::string list_toml(const std::vector<double> &values);
/// Words of keys of a material, in the order of their enumerations.
inline const std::vector<std::string> shadowing_names{"ashikhmin", "smith", "smith_directional",
                                                      "separable"};
inline const std::vector<std::string> interreflection_names{"none", "unpolarized",
                                                            "single_bounce_q"};

/// What an attitude takes from the scenario around it.
struct AttitudeContext {
  std::uint64_t seed = 0;               ///< of libration
  std::optional<Epoch<Utc>> begin = {}; ///< of the scenario: where a spin starts unless it says so
  bool is_piece = false;                ///< of a law of pieces
};
/// `folder`: of relative paths.
Result<AttitudeLaw> read_attitude(const Node &node, const std::filesystem::path &folder,
                                  const AttitudeContext &context);
/// [bands]: the curves are read.
Result<void> read_bands(const Node &top, const std::filesystem::path &folder, Scenario &out);
std::string bands_toml(const Scenario &scenario);
/// One [[object.part]].
Result<MovingJoint> read_part(const Node &node);
std::string part_toml(const MovingJoint &part);
/// One [material.NAME] table.
Result<Material> read_material_table(const Node &node, const std::string &name);
/// All [material.NAME] tables of a document; one that cannot be read is told, and has its name
/// there: objects name it.
std::map<std::string, Material> read_material_tables(const Node &top, Problems &problems);
/// Files of an object's orbit and, if `with_shape`, mesh and attitude that are not there.
void add_missing_files(const Scenario &scenario, std::size_t which, bool with_shape,
                       Problems &problems);
/// A material that a scenario names: its own, a built-in one or a TOML file.
Result<Material> find_material(const std::string &name, const Scenario &scenario);
/// The name is that of a file; and where it is, beside the scenario.
bool is_material_file(const std::string &name, const Scenario &scenario);
std::string material_file(const std::string &name, const Scenario &scenario);
/// TOML of one material table.
std::string material_toml(const Material &material);
/// A compiled-in material.
Result<Material> library_material(const std::string &name);
bool is_in_library(const std::string &name);
/// BadInput where a document's own material has the name of one of the paper's (paper_*) and
/// differs from it. Over a name of the library the document's own wins.
Result<void> check_own_names(const Node &top, const std::map<std::string, Material> &own);
/// The one [material.NAME] of a TOML text.
Result<Material> read_material_text(const std::string &text, const std::string &file);
/// A body axis as TOML.
std::string axis_toml(Vec3<Body> v);
/// A body axis: "+X" to "-Z" or [x, y, z]; `fallback` where the key is absent.
Result<Vec3<Body>> read_axis(const Node &node, const char *name, Vec3<Body> fallback);
/// TOML of an attitude, as an inline table.
std::string attitude_toml(const AttitudeLaw &law);
/// A TOML string with what must be escaped.
std::string quoted(const std::string &text);

} // namespace umov::scenario
