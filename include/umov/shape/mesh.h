#pragma once
// Triangles with material groups. Lengths in metres, axes of the body frame.

#include <array>
#include <cstdint>
#include <string>
#include <umov/core/vec3.h>
#include <vector>

namespace umov {

inline constexpr std::uint32_t no_index = 0xFFFFFFFF;

/// Three corners and the group that they belong to.
struct Triangle {
  std::array<std::uint32_t, 3> vertex{}; ///< into Mesh::positions, counter-clockwise from outside
  std::array<std::uint32_t, 3> normal{no_index, no_index, no_index}; ///< into Mesh::normals
  std::uint32_t front = 0; ///< into Mesh::groups: the side its winding faces
  std::uint32_t back = 0;  ///< the same unless two opposite faces were merged into one
};

/// Both sides of a triangle scatter; which one is seen follows from geometry.
struct Mesh {
  std::vector<Vec3<Body>> positions;
  std::vector<Vec3<Body>> normals; ///< unit vertex normals, used with normals = "smooth"
  std::vector<Triangle> triangles;
  /// Per triangle: direction of the texture's first coordinate; empty without texture coordinates.
  std::vector<Vec3<Body>> tangents;
  std::vector<std::string> groups; ///< names of mesh materials, in order of first use
  /// Per group: path in the tree of the file ("craft/bus/wing"); empty without a tree. With one,
  /// groups of several nodes may share a name.
  std::vector<std::string> nodes;
};

/// Twice the area times the unit geometric normal, by the right-hand rule over the winding.
inline Vec3<Body> area_vector_doubled(const Mesh &mesh, const Triangle &t) {
  const Vec3<Body> a = mesh.positions[t.vertex[0]];
  return cross(mesh.positions[t.vertex[1]] - a, mesh.positions[t.vertex[2]] - a);
}

} // namespace umov
