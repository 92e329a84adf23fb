#pragma once
// Wavefront OBJ and MTL.

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>
#include <umov/shape/mesh.h>
#include <vector>

namespace umov {

struct ObjOptions {
  std::string unit; ///< m, cm, mm, km, in, ft: what one unit of the file is; required
  std::string up;   ///< "+X" to "-Z": the file's axis that becomes body +Z; required
  std::size_t max_triangles = 5'000'000; ///< refused before the mesh is built
};

struct ObjMesh {
  Mesh mesh;                                ///< metres, body axes; groups in order of first use
  std::vector<std::string> defined;         ///< materials that the MTL files define
  bool lacks_mtl = false;                   ///< a named MTL file could not be read
  std::vector<std::filesystem::path> files; ///< MTL files that were read
};

/// Reads a mesh in double precision. Polygons of any size become triangles; `usemtl` names the
/// group (without one the object or group name, else "default"). Rotation for `up`: +Z none, +Y
/// (x,y,z)->(x,-z,y), +X (x,y,z)->(y,z,x), and for -Z, -Y, -X (x,-y,-z), (x,z,-y), (-y,z,-x):
/// all proper. BadInput with file, line and column for whatever cannot be read; warnings for lines
/// that are skipped (points, lines, faces of two corners), odd polygons and a doubtful unit.
Result<ObjMesh> read_obj(const std::filesystem::path &path, const ObjOptions &options,
                         Diagnostics &diagnostics);

/// Gives the text of an MTL file of that name, or an error.
using MtlLoader = std::function<Result<std::string>(const std::string &name)>;
Result<ObjMesh> read_obj_text(std::string_view text, const std::string &file,
                              const ObjOptions &options, const MtlLoader &load_mtl,
                              Diagnostics &diagnostics);

/// Whether the OBJ names its MTL file.
enum class MtlUse { Named, None };

struct ObjText {
  std::string obj, mtl;
};
/// The mesh in metres, +Z up; `name` is the stem of the files. Two-sided faces become two opposite
/// ones, which `clean` joins again. Reading it gives the same numbers, bit for bit.
ObjText write_obj(const Mesh &mesh, const std::string &name, MtlUse mtl = MtlUse::Named);

} // namespace umov
