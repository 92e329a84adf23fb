#pragma once
// Meshes there and back.

#include "fuzz/target.h"

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

} // namespace umov::fuzz
