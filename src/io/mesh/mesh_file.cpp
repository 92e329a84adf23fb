#include <umov/io/mesh_file.h>

#include "io/mesh/mesh_parts.h"
#include "io/mesh/off_check.h"
#include "io/mesh/readers.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/stop.h>
#include <umov/core/text.h>
#include <umov/io/obj.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

namespace fs = std::filesystem;

enum class Kind { Obj, Stl, Ply, Gltf, Other, Unknown };

std::string suffix_of(const fs::path &path) {
  std::string out = path.extension().string();
  for (char &c : out)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

/// True if a line of the first part of a text is a vertex as OBJ has it.
bool looks_like_obj(std::string_view text) {
  text = text.substr(0, 64u << 10);
  return text.starts_with("v ") || text.find("\nv ") != std::string_view::npos;
}

Kind kind_of_suffix(const std::string &suffix) {
  if (suffix == ".obj")
    return Kind::Obj;
  if (suffix == ".stl")
    return Kind::Stl;
  if (suffix == ".ply")
    return Kind::Ply;
  if (suffix == ".gltf" || suffix == ".glb")
    return Kind::Gltf;
  const auto others = other_mesh_suffixes();
  return std::find(others.begin(), others.end(), suffix) != others.end() ? Kind::Other
                                                                         : Kind::Unknown;
}

/// What the content says, where it says anything; else the suffix.
Kind kind_of(std::string_view bytes, const std::string &suffix) {
  if (bytes.starts_with("glTF"))
    return Kind::Gltf;
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r"))
    return Kind::Ply;
  if (mesh_io::is_binary_stl(bytes) || mesh_io::is_text_stl(bytes))
    return Kind::Stl;
  const std::size_t first = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string_view::npos && bytes[first] == '{')
    return Kind::Gltf;
  const Kind named = kind_of_suffix(suffix);
  return named == Kind::Unknown && looks_like_obj(bytes) ? Kind::Obj : named;
}

/// Assimp opens the file itself, also those beside it: it must be the one whose bytes are known.
Result<MeshFile> read_other(std::string_view bytes, const fs::path &path, MeshFileOptions &options,
                            Diagnostics &diagnostics) {
  if (suffix_of(path) == ".off")
    UMOV_TRY(mesh_io::check_off(bytes, path.string(), options.cancel));
  UMOV_ASSIGN(out, mesh_io::read_with_assimp(path, options, diagnostics));
  UMOV_ASSIGN(now, read_file(path));
  if (now != bytes)
    return fail(ErrorCode::BadInput, "changed while it was read; start again", {path.string()});
  return std::move(out);
}

Result<MeshFile> read_kind(Kind kind, std::string_view bytes, const fs::path &path,
                           MeshFileOptions &options, Diagnostics &diagnostics) {
  switch (kind) {
  case Kind::Stl:
    return mesh_io::read_stl(bytes, path.string(), options, diagnostics);
  case Kind::Ply:
    return mesh_io::read_ply(bytes, path.string(), options, diagnostics);
  case Kind::Gltf: { // its specification fixes both; who says otherwise knows the file better
    options.unit = options.unit.empty() ? "m" : options.unit;
    options.up = options.up.empty() ? "+Y" : options.up;
    return mesh_io::read_gltf(bytes, path, options, diagnostics);
  }
  case Kind::Other:
    return read_other(bytes, path, options, diagnostics);
  case Kind::Obj:
  case Kind::Unknown:
    break;
  }
  if (bytes.starts_with("\x1F\x8B") || bytes.starts_with("PK\x03\x04"))
    return fail(ErrorCode::BadInput, why_no_text(bytes).value(), {path.string()});
  return fail(ErrorCode::BadInput,
              fmt::format("neither the content nor the suffix tells which kind of mesh this is; "
                          ".obj, .gltf, .glb, .stl, .ply, {} were expected. Rename or convert it.",
                          fmt::join(other_mesh_suffixes(), ", ")),
              {path.string()});
}

} // namespace

Result<MeshFile> read_mesh(const fs::path &path, const MeshFileOptions &options,
                           Diagnostics &diagnostics) {
  UMOV_ASSIGN(bytes, read_file(path));
  return read_mesh_bytes(bytes, path, options, diagnostics);
}

Result<MeshFile> read_mesh_bytes(std::string_view bytes, const fs::path &path,
                                 const MeshFileOptions &options, Diagnostics &diagnostics) {
  const Kind kind = kind_of(bytes, suffix_of(path));
  if (kind == Kind::Obj)
    return mesh_io::read_obj_bytes(bytes, path, options, diagnostics);
  return without_failures([&]() -> Result<MeshFile> {
    MeshFileOptions filled = options;
    UMOV_ASSIGN(out, read_kind(kind, bytes, path, filled, diagnostics));
    UMOV_TRY(mesh_io::to_body_frame(out, filled, path.string(), diagnostics));
    return std::move(out);
  });
}

Result<void> write_mesh(const fs::path &path, const Mesh &mesh, Diagnostics &diagnostics) {
  const std::string suffix = suffix_of(path);
  if (suffix == ".obj") {
    const ObjText text = write_obj(mesh, path.stem().string());
    UMOV_TRY(write_file_atomically(fs::path(path).replace_extension(".mtl"), text.mtl));
    return write_file_atomically(path, text.obj);
  }
  if (suffix == ".glb")
    return write_file_atomically(path, mesh_io::write_glb(mesh));
  if (suffix == ".gltf")
    return write_file_atomically(path, mesh_io::write_gltf(mesh));
  if (suffix != ".stl" && suffix != ".ply")
    return fail(ErrorCode::Usage, "-o " + path.string() +
                                      ": a name that ends in .obj, .glb, .gltf, .stl or .ply was "
                                      "expected");
  if (const std::size_t count = with_joined_groups(mesh).groups.size(); count > 1)
    diagnostics.warn(fmt::format("{} holds no materials: {} of them became one", suffix, count),
                     {path.string()});
  return write_file_atomically(path, suffix == ".stl" ? mesh_io::write_stl(mesh)
                                                      : mesh_io::write_ply(mesh));
}

} // namespace umov
