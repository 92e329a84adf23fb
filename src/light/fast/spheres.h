#pragma once
// Private: spheres that hold parts of a mesh, to tell quickly what cannot hide what.

#include <span>
#include <umov/core/vec3.h>
#include <umov/shape/mesh.h>
#include <vector>

namespace umov {

struct Sphere {
  Vec3<Body> centre{};
  double radius = 0;
};

Sphere around(std::span<const Vec3<Body>> points);
/// Spheres that hold a mesh: its triangles halved along their longest spread until there are 32.
std::vector<Sphere> cover(const Mesh &mesh);
/// Something of `other` may stand in a direction from something of `from`.
bool may_hide(const Sphere &from, const Sphere &other, Vec3<Body> direction);

} // namespace umov
