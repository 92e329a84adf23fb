#pragma once
// Wavefront OBJ and MTL.

#include <functional>
#include <string>
#include <string_view>
#include <umov/io/mesh_file.h>

namespace umov {

/// Reads a mesh in double precision. Polygons of any size become triangles; `usemtl` names the
/// group (without one the object or group name, else "default"). `unit` and `up` are required.
/// BadInput with file, line and column for whatever cannot be read; warnings for lines that are
/// skipped (points, lines, faces of two corners), odd polygons and a doubtful unit.
Result<MeshFile> read_obj(const std::filesystem::path &path, const MeshFileOptions &options,
                          Diagnostics &diagnostics);

/// Gives the text of an MTL file of that name, or an error.
using MtlLoader = std::function<Result<std::string>(const std::string &name)>;
/// The same from a text; `load_mtl` is asked for the MTL files that it names.
Result<MeshFile> read_obj_text(std::string_view text, const std::string &file,
                               const MeshFileOptions &options, const MtlLoader &load_mtl,
                               Diagnostics &diagnostics);

/// Whether the OBJ names its MTL file.
enum class MtlUse { Named, None };

/// The texts of an OBJ file and of its MTL file.
struct ObjText {
  std::string obj, mtl;
};
/// The mesh in metres, +Z up; `name` is the stem of the files. Two-sided faces become two opposite
/// ones, which `clean_mesh` joins again. Reading it gives the same numbers, bit for bit.
ObjText write_obj(const Mesh &mesh, const std::string &name, MtlUse mtl = MtlUse::Named);

} // namespace umov
