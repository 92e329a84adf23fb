#pragma once
// Private: where the nodes of a glTF tree put their meshes.

#include <array>
#include <nlohmann/json.hpp>
#include <umov/core/result.h>
#include <umov/core/vec3.h>

namespace umov::mesh_io::gltf {

class Document;

/// x -> columns x + origin; columns need be neither orthogonal nor right-handed.
struct Placement {
  std::array<Vec3<Body>, 3> column{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3<Body> origin{};

  [[nodiscard]] Vec3<Body> linear(Vec3<Body> v) const {
    return column[0] * v.x + column[1] * v.y + column[2] * v.z;
  }
  [[nodiscard]] Vec3<Body> point(Vec3<Body> p) const { return linear(p) + origin; }
  /// Above zero where windings stay, below where they must be turned round.
  [[nodiscard]] double determinant() const { return dot(column[0], cross(column[1], column[2])); }
  /// Direction of a normal (not a unit vector): by the cofactors, which exist for flat scales too.
  [[nodiscard]] Vec3<Body> normal(Vec3<Body> n) const {
    const Vec3<Body> out = cross(column[1], column[2]) * n.x + cross(column[2], column[0]) * n.y +
                           cross(column[0], column[1]) * n.z;
    return determinant() < 0 ? -out : out;
  }
  friend Placement operator*(const Placement &a, const Placement &b) {
    return {{a.linear(b.column[0]), a.linear(b.column[1]), a.linear(b.column[2])},
            a.point(b.origin)};
  }
};

/// The placement of a node in its parent: its matrix, or translation, rotation and scale.
Result<Placement> placement_of(const Document &document, std::size_t node);

} // namespace umov::mesh_io::gltf
