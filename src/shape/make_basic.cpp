#include <umov/shape/primitives.h>

#include "shape/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace umov {
namespace {

/// Corners of the icosahedron and its 20 faces, wound outward.
struct Icosahedron {
  std::array<Vec3<Body>, 12> corner{};
  std::vector<std::array<std::size_t, 3>> faces;

  Icosahedron() {
    // Two poles and two rings of five at the height 1/sqrt(5).
    corner[0] = {0, 0, 1};
    corner[11] = {0, 0, -1};
    const double height = 1 / std::sqrt(5.0), radius = 2 * height;
    for (std::size_t i = 0; i < 5; ++i) {
      const double upper = 2 * pi * static_cast<double>(i) / 5, lower = upper + pi / 5;
      corner[1 + i] = {radius * std::cos(upper), radius * std::sin(upper), height};
      corner[6 + i] = {radius * std::cos(lower), radius * std::sin(lower), -height};
    }
    for (std::size_t i = 0; i < 5; ++i) {
      const std::size_t j = (i + 1) % 5;
      faces.push_back({0, 1 + i, 1 + j});
      faces.push_back({1 + i, 6 + i, 1 + j});
      faces.push_back({6 + i, 6 + j, 1 + j});
      faces.push_back({11, 6 + j, 6 + i});
    }
  }
};

/// Unit sphere: an icosahedron whose faces are cut into n^2 triangles each. Corners divide the
/// edges by equal angles (weights sin(t w), which on an edge is the great circle), so that the
/// triangles stay of like size.
Mesh unit_sphere(std::size_t facets, const std::string &group) {
  std::size_t n = 1;
  while (20 * n * n < facets)
    ++n;
  MeshBuilder builder;
  const std::uint32_t g = builder.group(group);
  const Icosahedron solid;
  const double edge = std::acos(1 / std::sqrt(5.0)), step = edge / static_cast<double>(n);
  for (const auto &face : solid.faces) {
    const auto corner = [&](std::size_t i, std::size_t j) {
      const double u = step * static_cast<double>(i), v = step * static_cast<double>(j);
      return normalized(solid.corner[face[0]] * std::sin(edge - u - v) +
                        solid.corner[face[1]] * std::sin(u) + solid.corner[face[2]] * std::sin(v));
    };
    const auto add = [&](Vec3<Body> p, Vec3<Body> q, Vec3<Body> r) {
      builder.triangle(g, {p, q, r}, {p, q, r});
    };
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; i + j < n; ++j) {
        add(corner(i, j), corner(i + 1, j), corner(i, j + 1));
        if (i + j + 1 < n)
          add(corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
      }
  }
  return builder.mesh;
}

} // namespace

Mesh make_sphere(double radius_m, std::size_t facets) {
  Mesh mesh = unit_sphere(facets, "sphere");
  for (Vec3<Body> &p : mesh.positions)
    p = p * radius_m;
  return mesh;
}

Mesh make_ellipsoid(double a_m, double b_m, double c_m, std::size_t facets) {
  Mesh mesh = unit_sphere(facets, "cigar");
  for (Vec3<Body> &p : mesh.positions)
    p = {p.x * a_m, p.y * b_m, p.z * c_m};
  for (Vec3<Body> &n : mesh.normals) // the gradient of x^2/a^2 + y^2/b^2 + z^2/c^2
    n = normalized(Vec3<Body>{n.x / a_m, n.y / b_m, n.z / c_m});
  return mesh;
}

Mesh make_plate(double width_m, double height_m, bool two_sided) {
  MeshBuilder builder;
  const double w = width_m / 2, h = height_m / 2;
  builder.flat(builder.group(two_sided ? "front" : "plate"),
               {{-w, -h, 0}, {w, -h, 0}, {w, h, 0}, {-w, h, 0}});
  if (two_sided) // the same diagonal: the two faces coincide triangle by triangle
    builder.flat(builder.group("back"), {{-w, -h, 0}, {-w, h, 0}, {w, h, 0}, {w, -h, 0}});
  return builder.mesh;
}

Mesh make_cylinder(double radius_m, double length_m, std::size_t sides) {
  MeshBuilder builder;
  const std::uint32_t side = builder.group("side"), caps = builder.group("caps");
  const double h = length_m / 2;
  builder.revolve({{-h, 0}, {-h, radius_m}, {h, radius_m}, {h, 0}}, sides, {},
                  [&](std::size_t segment, std::size_t) { return segment == 1 ? side : caps; });
  return builder.mesh;
}

Mesh make_chamfered_cube(double edge_m, double chamfer_m) {
  MeshBuilder builder;
  const std::uint32_t g = builder.group("cube");
  const double h = edge_m / 2, i = h - chamfer_m;
  // Each corner of a face: on axis `a` at +-h, on the two others at +-i.
  const auto point = [&](std::size_t a, std::array<double, 3> sign) {
    std::array<double, 3> v{sign[0] * i, sign[1] * i, sign[2] * i};
    v[a] = sign[a] * h;
    return Vec3<Body>{v[0], v[1], v[2]};
  };
  const auto add = [&](std::vector<Vec3<Body>> c) { // outward: away from the centre
    if (dot(cross(c[1] - c[0], c[2] - c[0]), c[0]) < 0)
      std::reverse(c.begin(), c.end());
    builder.flat(g, c);
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    for (const double s : {-1.0, 1.0}) {
      std::vector<Vec3<Body>> face;
      for (const auto &[u, v] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
        std::array<double, 3> sign{};
        sign[a] = s;
        sign[b] = u;
        sign[c] = v;
        face.push_back(point(a, sign));
      }
      add(face);
      for (const double t : {-1.0, 1.0}) { // the edge between face (a, s) and face (b, t)
        std::array<double, 3> low{}, high{};
        low[a] = high[a] = s;
        low[b] = high[b] = t;
        low[c] = -1;
        high[c] = 1;
        add({point(a, low), point(a, high), point(b, high), point(b, low)});
      }
    }
  }
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0})
        add({point(0, {x, y, z}), point(1, {x, y, z}), point(2, {x, y, z})});
  return builder.mesh;
}

} // namespace umov
