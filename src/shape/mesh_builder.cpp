#include "shape/mesh_builder.h"

#include <algorithm>

namespace umov {

std::uint32_t MeshBuilder::group(const std::string &name) {
  const auto found = std::find(mesh.groups.begin(), mesh.groups.end(), name);
  if (found != mesh.groups.end())
    return static_cast<std::uint32_t>(found - mesh.groups.begin());
  mesh.groups.push_back(name);
  return static_cast<std::uint32_t>(mesh.groups.size() - 1);
}

std::uint32_t MeshBuilder::position(Vec3<Body> p) {
  mesh.positions.push_back(p);
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

std::uint32_t MeshBuilder::normal(Vec3<Body> n) {
  if (mesh.normals.empty() || !(mesh.normals.back() == n)) // runs of one normal are common
    mesh.normals.push_back(n);
  return static_cast<std::uint32_t>(mesh.normals.size() - 1);
}

void MeshBuilder::triangle(std::uint32_t group_index, std::array<Vec3<Body>, 3> p,
                           std::array<Vec3<Body>, 3> n) {
  Triangle t;
  t.front = t.back = group_index;
  for (std::size_t k = 0; k < 3; ++k) {
    t.vertex[k] = position(p[k]);
    t.normal[k] = normal(n[k]);
  }
  mesh.triangles.push_back(t);
}

void MeshBuilder::flat(std::uint32_t group_index, const std::vector<Vec3<Body>> &c) {
  const Vec3<Body> n = normalized(cross(c[1] - c[0], c[2] - c[0]));
  for (std::size_t i = 1; i + 1 < c.size(); ++i)
    triangle(group_index, {c[0], c[i], c[i + 1]}, {n, n, n});
}

void MeshBuilder::revolve(const std::vector<Outline> &outline, std::size_t sides,
                          const Placement &place,
                          const std::function<std::uint32_t(std::size_t, std::size_t)> &group_of) {
  const auto at = [&](const Outline &o, std::size_t side) {
    const double phi = 2 * pi * static_cast<double>(side % sides) / static_cast<double>(sides);
    return place.point({o.r * std::cos(phi), o.r * std::sin(phi), o.z});
  };
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    const Outline a = outline[i], b = outline[i + 1];
    const double length = std::hypot(b.z - a.z, b.r - a.r);
    const double radial = (b.z - a.z) / length, axial = -(b.r - a.r) / length;
    const auto normal_at = [&](double side) {
      const double phi = 2 * pi * side / static_cast<double>(sides);
      return place.direction({radial * std::cos(phi), radial * std::sin(phi), axial});
    };
    for (std::size_t s = 0; s < sides; ++s) {
      const auto side = static_cast<double>(s);
      const Vec3<Body> left = normal_at(side), right = normal_at(side + 1);
      // At the axis a ring shrinks to a point, whose normal is that of the middle of the side.
      const Vec3<Body> tip = normal_at(side + 0.5);
      const std::uint32_t g = group_of(i, s);
      if (b.r > 0)
        triangle(g, {at(a, s), at(b, s + 1), at(b, s)}, {a.r > 0 ? left : tip, right, left});
      if (a.r > 0)
        triangle(g, {at(a, s), at(a, s + 1), at(b, s + 1)}, {left, right, b.r > 0 ? right : tip});
    }
  }
}

void MeshBuilder::cylinder(double radius, double length, std::size_t sides, const Placement &place,
                           std::uint32_t group_index) {
  revolve({{0, 0}, {0, radius}, {length, radius}, {length, 0}}, sides, place,
          [&](std::size_t, std::size_t) { return group_index; });
}

void MeshBuilder::box(Vec3<Body> h, const Placement &place, std::uint32_t top, std::uint32_t bottom,
                      std::uint32_t sides) {
  const auto p = [&](double x, double y, double z) {
    return place.point({x * h.x, y * h.y, z * h.z});
  };
  flat(top, {p(-1, -1, 1), p(1, -1, 1), p(1, 1, 1), p(-1, 1, 1)});
  flat(bottom, {p(-1, 1, -1), p(1, 1, -1), p(1, -1, -1), p(-1, -1, -1)});
  flat(sides, {p(1, -1, -1), p(1, 1, -1), p(1, 1, 1), p(1, -1, 1)});
  flat(sides, {p(-1, 1, -1), p(-1, -1, -1), p(-1, -1, 1), p(-1, 1, 1)});
  flat(sides, {p(1, 1, -1), p(-1, 1, -1), p(-1, 1, 1), p(1, 1, 1)});
  flat(sides, {p(-1, -1, -1), p(1, -1, -1), p(1, -1, 1), p(-1, -1, 1)});
}

} // namespace umov
