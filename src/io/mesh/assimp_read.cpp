// Formats that Assimp reads for us: those whose unit and axes are certain. Others (FBX, LWO, ...)
// come out turned or scaled in ways that depend on the program that wrote them.

#include "io/mesh/assimp_child.h"
#include "io/mesh/assimp_scene.h"
#include "io/mesh/readers.h"

#include <array>
#include <fmt/format.h>

namespace umov {
namespace mesh_io {
namespace {

struct Format {
  const char *suffix, *name;
  /// The file states unit and up: Assimp scales to metres and turns to +Y up.
  bool is_stated;
  /// Assimp turns to +Y up although the file states nothing.
  bool is_turned;
};
constexpr std::array formats{Format{".3ds", "3DS", false, true},
                             Format{".dae", "COLLADA", true, false},
                             Format{".off", "OFF", false, false}};

const Format *format_of(const std::filesystem::path &path) {
  std::string suffix = path.extension().string();
  for (char &c : suffix)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  for (const Format &one : formats)
    if (suffix == one.suffix)
      return &one;
  return nullptr;
}

} // namespace

Result<MeshFile> read_with_assimp(const std::filesystem::path &path, MeshFileOptions &options,
                                  Diagnostics &diagnostics) {
  const Format *format = format_of(path);
  if (format == nullptr)
    return fail(ErrorCode::Internal, "no format of Assimp", {path.string()});
  if (format->is_stated && options.unit.empty() != options.up.empty())
    return fail(ErrorCode::BadInput,
                fmt::format("{} states its unit and up axis itself; give both to overrule it, or "
                            "none",
                            format->name),
                {path.string()});
  const bool is_overruled = format->is_stated && !options.unit.empty();
  UMOV_ASSIGN(packed, import_in_child(path, format->is_turned || is_overruled, {}, options.cancel));
  if (format->is_stated && !is_overruled) {
    options.unit = "m";
    options.up = "+Y";
  }
  UMOV_ASSIGN(out, unpack_scene(packed, path.string(), options, diagnostics));
  out.format = format->name;
  return std::move(out);
}

} // namespace mesh_io

std::vector<std::string> other_mesh_suffixes() {
  std::vector<std::string> out;
  out.reserve(mesh_io::formats.size());
  for (const mesh_io::Format &one : mesh_io::formats)
    out.emplace_back(one.suffix);
  return out;
}

} // namespace umov
