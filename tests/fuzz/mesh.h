#pragma once
// Meshes there and back.

#include "fuzz/target.h"
#include "io/mesh/mesh_parts.h"

#include <cmath>
#include <umov/core/diagnostics.h>
#include <umov/io/mesh_file.h>

namespace umov::fuzz {

/// Small, so that an input with few bytes and many triangles stays fast.
inline MeshFileOptions mesh_options(std::string unit = "m", std::string up = "+Z") {
  return {std::move(unit), std::move(up), 20'000};
}

/// What every reader promises of its mesh.
inline void check_mesh(const Mesh &mesh) {
  require(!mesh.triangles.empty() && mesh.triangles.size() <= 20'000, "between 1 and the most");
  require(mesh.tangents.empty() || mesh.tangents.size() == mesh.triangles.size(),
          "a tangent for each triangle or none");
  for (const Vec3<Body> &p : mesh.positions)
    require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "finite positions");
  for (const Triangle &t : mesh.triangles) {
    require(t.front < mesh.groups.size() && t.back < mesh.groups.size(), "groups that are there");
    for (std::size_t k = 0; k < 3; ++k)
      require(t.vertex[k] < mesh.positions.size() &&
                  (t.normal[k] == no_index || t.normal[k] < mesh.normals.size()),
              "corners that are there");
  }
}

/// The same positions and corners, to the bit.
inline bool is_same_shape(const Mesh &a, const Mesh &b) {
  if (a.positions.size() != b.positions.size() || a.triangles.size() != b.triangles.size())
    return false;
  for (std::size_t k = 0; k < a.positions.size(); ++k)
    if (a.positions[k].x != b.positions[k].x || a.positions[k].y != b.positions[k].y ||
        a.positions[k].z != b.positions[k].z)
      return false;
  for (std::size_t k = 0; k < a.triangles.size(); ++k)
    if (a.triangles[k].vertex != b.triangles[k].vertex ||
        a.groups[a.triangles[k].front] != b.groups[b.triangles[k].front])
      return false;
  return true;
}

/// Formats of 32 bits: what was written once is written the same again.
template <class Read, class Write>
void check_written_twice(const Mesh &mesh, const Read &read, const Write &write) {
  const std::string first = write(mesh);
  const auto back = read(first);
  if (!is_read(back)) // beyond the range of 32 bits
    return;
  const std::string second = write(back->mesh);
  const auto again = must(read(second), "what was read can be written and read");
  require(is_same_shape(back->mesh, again.mesh), "32 bits keep what has 32 bits");
}

/// One format: read as read_mesh_bytes reads it, but whatever the bytes look like; there and back
/// by each writer.
template <class Reader, class... Writers>
int try_format(std::string_view bytes, const MeshFileOptions &options, const Reader &reader,
               const Writers &...writers) {
  const auto read = [&](std::string_view text) -> Result<MeshFile> {
    Diagnostics diagnostics;
    auto out = reader(text, options, diagnostics);
    if (out)
      UMOV_TRY(mesh_io::to_body_frame(*out, options, "input", diagnostics));
    return out;
  };
  const auto mesh = read(bytes);
  if (!is_read(mesh))
    return 0;
  check_mesh(mesh->mesh);
  (check_written_twice(mesh->mesh, read, writers), ...);
  return 0;
}

} // namespace umov::fuzz
