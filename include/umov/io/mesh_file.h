#pragma once
// Files of meshes, whatever their format.

#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>
#include <umov/shape/mesh.h>
#include <vector>

namespace umov {

/// What a file of a mesh does not say about itself.
struct MeshFileOptions {
  std::string unit;                      ///< m, cm, mm, km, in, ft: what one unit of the file is
  std::string up;                        ///< "+X" to "-Z": the file's axis that becomes body +Z
  std::size_t max_triangles = 5'000'000; ///< refused before the mesh is built
  bool is_of_command = false; ///< hints name options of a command, not keys of a scenario
  const std::atomic<bool> *cancel = nullptr; ///< ends the reading where it comes true
  bool asks_for_mtl = true; ///< false: nothing of an MTL file is needed, and none is missed
};

/// A node of the file's tree that has faces.
struct MeshNode {
  std::string path;      ///< names from the root down, "craft/bus/wing_left"
  Vec3<Body> origin_m{}; ///< where the node's own origin lies: often the pivot of its hinge
  std::size_t triangles = 0;
  friend bool operator==(const MeshNode &, const MeshNode &) = default;
};

/// A further file that belongs to a mesh, and the hash of what was read.
struct MeshPart {
  std::filesystem::path path;
  std::string sha256;
};

/// A mesh and what its file told besides.
struct MeshFile {
  Mesh mesh;                        ///< metres, body axes; groups in order of first use
  std::string format;               ///< "OBJ", "STL", "PLY", "glTF" or the name of another one
  std::vector<MeshNode> nodes;      ///< empty where the format has no tree
  std::vector<std::string> defined; ///< OBJ: materials that the MTL files define
  std::vector<MeshPart> files;      ///< further files that were read (MTL, glTF buffers)
};

/// Reads a mesh: OBJ, STL (text and binary), PLY, glTF and GLB with readers of our own, and what
/// `other_mesh_suffixes` lists through Assimp. The content decides where it tells (STL, PLY, glTF),
/// else the suffix. `unit` and `up` are required except where the format states them (glTF: metres,
/// +Y up); given ones win. Rotation for `up`: +Z none, +Y (x,y,z)->(x,-z,y), +X (x,y,z)->(y,z,x),
/// and for -Z, -Y, -X (x,-y,-z), (x,z,-y), (-y,z,-x): all proper. Groups are the file's material
/// names, else object names, else "default"; with a tree there is one group for each pair of
/// material and node (`Mesh::nodes`). BadInput names what was found, what was expected, what to do;
/// no file, however broken, ends the program, and none is believed about its size. Interrupted
/// where MeshFileOptions::cancel comes true.
Result<MeshFile> read_mesh(const std::filesystem::path &path, const MeshFileOptions &options,
                           Diagnostics &diagnostics);

/// The same from the bytes of the file `path`, beside which further files are looked for. Assimp
/// reads for itself: BadInput where it can no longer have found these bytes.
Result<MeshFile> read_mesh_bytes(std::string_view bytes, const std::filesystem::path &path,
                                 const MeshFileOptions &options, Diagnostics &diagnostics);

/// Suffixes (with the point) of the formats that Assimp reads for us.
std::vector<std::string> other_mesh_suffixes();

/// Writes a mesh in metres as OBJ (with its MTL beside it), STL (binary), PLY (binary), glTF or GLB
/// (+Y up, the tree of nodes kept): the suffix decides, and any other one is a Usage error. OBJ
/// keeps every bit; the others hold numbers of 32 bits. Warns of what the format cannot hold.
Result<void> write_mesh(const std::filesystem::path &path, const Mesh &mesh,
                        Diagnostics &diagnostics);

} // namespace umov
