#pragma once
// Private: a scene of Assimp as bytes, and the mesh in these bytes.

#include "io/mesh/mesh_parts.h"

#include <string>
#include <string_view>
#include <umov/io/mesh_file.h>

struct aiScene;

namespace umov::mesh_io {

/// Every mesh at every node that shows it, placed and wound as the node has it, polygons whole.
/// Runs in the child, whose memory is limited.
std::string pack_scene(const aiScene &scene, bool drops_root);

/// The mesh of a packed scene, as it stands in the file. The bytes come from a process that a
/// hostile file may have led astray: nothing in them is believed.
Result<MeshFile> unpack_scene(std::string_view bytes, const std::string &file,
                              const MeshFileOptions &options, Diagnostics &diagnostics);

} // namespace umov::mesh_io
