#pragma once
// What a mesh file holds.

#include <string>
#include <umov/core/diagnostics.h>
#include <umov/io/mesh_file.h>
#include <umov/io/table.h>
#include <umov/shape/topology.h>
#include <vector>

namespace umov::jobs {

/// A mesh file looked at.
struct MeshDescription {
  std::string format; ///< as it was read
  std::vector<std::string> groups;
  std::vector<MeshNode> nodes; ///< of the file's tree, where it has one
  MeshReport report;
};

/// How a file is looked at.
enum class MeshLook {
  AsRead,
  Cleaned ///< what is left when a scene is made of it, with what was found on the way
};

/// Reads and inspects a mesh; triangles that a scene would drop are counted either way.
/// Interrupted where MeshFileOptions::cancel comes true.
Result<MeshDescription> describe_mesh(const std::string &path, const MeshFileOptions &options,
                                      MeshLook look, Diagnostics &diagnostics);

/// A row per material of the mesh.
Table group_table(const MeshDescription &mesh);
/// A row per node of the file's tree: the parts of a scenario may name them.
Table node_table(const MeshDescription &mesh);
/// All of it.
std::string to_json(const MeshDescription &mesh);

} // namespace umov::jobs
