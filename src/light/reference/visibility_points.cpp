#include "light/reference/visibility_points.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

/// Height of the tangent plane at a corner over the point, along the corner's normal, if above it.
double height_of_plane(Vec3<Body> point, Vec3<Body> corner, Vec3<Body> normal) {
  return std::max(0.0, dot(corner - point, normal));
}

} // namespace

std::array<double, 2> point_in_cell(std::size_t cuts, std::size_t cell, double x, double y) {
  if (x + y > 1) {
    x = 1 - x;
    y = 1 - y;
  }
  // Row r holds r + 1 upright cells and between them r inverted ones.
  std::size_t row = static_cast<std::size_t>(std::sqrt(static_cast<double>(cell)));
  while (row * row > cell)
    --row;
  while ((row + 1) * (row + 1) <= cell)
    ++row;
  const std::size_t within = cell - row * row;
  const double i = static_cast<double>(within / 2), r = static_cast<double>(row);
  const double k = static_cast<double>(cuts);
  if (within % 2 == 0)
    return {(i + x) / k, (r - i + y) / k};
  return {(i + 1 - x) / k, (r - i - y) / k};
}

Vec3<Body> ray_origin(const Scene &scene, const Elements &elements, const LitElement &lit,
                      const Element &e, std::array<double, 2> point) {
  const Mesh &mesh = scene.mesh;
  const Triangle &t = mesh.triangles[e.triangle];
  const double side = static_cast<double>(lit.side);
  std::array<double, 2> uv{};
  for (std::size_t k = 0; k < 2; ++k)
    uv[k] = e.corner[0][k] + point[0] * (e.corner[1][k] - e.corner[0][k]) +
            point[1] * (e.corner[2][k] - e.corner[0][k]);
  const std::array<double, 3> weight{1 - uv[0] - uv[1], uv[0], uv[1]};
  Vec3<Body> on_face{};
  for (std::size_t k = 0; k < 3; ++k)
    on_face += weight[k] * mesh.positions[t.vertex[k]];
  const Vec3<Body> face = side * elements.normal[e.triangle];
  Vec3<Body> origin = on_face + (ray_offset * elements.size_m) * face;
  if (e.is_flat)
    return origin;
  for (std::size_t k = 0; k < 3; ++k) {
    if (t.normal[k] == no_index)
      continue;
    Vec3<Body> normal = side * normalized(mesh.normals[t.normal[k]]);
    if (dot(normal, face) < 0)
      normal = -normal;
    origin += weight[k] * height_of_plane(on_face, mesh.positions[t.vertex[k]], normal) * normal;
  }
  return origin;
}

} // namespace umov
