#pragma once
// Private: the readers and writers behind `read_mesh` and `write_mesh`, on texts in memory. The
// readers leave the mesh as it stands in the file; `to_body_frame` comes after.

#include <string>
#include <string_view>
#include <umov/io/mesh_file.h>

namespace umov::mesh_io {

/// True if the size of the file is the one that its count of triangles asks for.
bool is_binary_stl(std::string_view bytes);
/// True if a text begins as STL does and has facets.
bool is_text_stl(std::string_view bytes);

/// OBJ; `path` says where MTL files are looked for.
Result<MeshFile> read_obj_bytes(std::string_view bytes, const std::filesystem::path &path,
                                const MeshFileOptions &options, Diagnostics &diagnostics);
Result<MeshFile> read_stl(std::string_view bytes, const std::string &file,
                          const MeshFileOptions &options, Diagnostics &diagnostics);
Result<MeshFile> read_ply(std::string_view bytes, const std::string &file,
                          const MeshFileOptions &options, Diagnostics &diagnostics);
/// glTF 2.0 as JSON or GLB; `path` says where external buffers are looked for.
Result<MeshFile> read_gltf(std::string_view bytes, const std::filesystem::path &path,
                           const MeshFileOptions &options, Diagnostics &diagnostics);
/// What Assimp reads. Fills in unit and up where the format states them and `options` does not.
Result<MeshFile> read_with_assimp(const std::filesystem::path &path, MeshFileOptions &options,
                                  Diagnostics &diagnostics);

std::string write_stl(const Mesh &mesh);
std::string write_ply(const Mesh &mesh);
std::string write_glb(const Mesh &mesh);
/// JSON with its buffer inside.
std::string write_gltf(const Mesh &mesh);

} // namespace umov::mesh_io
