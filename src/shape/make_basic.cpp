#include <umov/shape/primitives.h>

#include "shape/mesh_builder.h"

#include <algorithm>
#include <array>

namespace umov {
namespace {

/// Unit sphere: an octahedron whose faces are cut into n^2 triangles each, corners moved out to the
/// sphere along great circles of equal steps, so that triangles stay of like size.
Mesh unit_sphere(std::size_t facets, const std::string &group) {
  std::size_t n = 1;
  while (8 * n * n < facets)
    ++n;
  MeshBuilder builder;
  const std::uint32_t g = builder.group(group);
  const std::array<Vec3<Body>, 6> tips{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0},
                                        {0, 0, -1}}};
  const auto corner = [&](Vec3<Body> a, Vec3<Body> b, Vec3<Body> c, std::size_t i, std::size_t j) {
    const double u = static_cast<double>(i), v = static_cast<double>(j);
    const double w = static_cast<double>(n) - u - v;
    return normalized(a * std::sin(pi / 2 * w / static_cast<double>(n)) +
                      b * std::sin(pi / 2 * u / static_cast<double>(n)) +
                      c * std::sin(pi / 2 * v / static_cast<double>(n)));
  };
  const auto add = [&](Vec3<Body> p, Vec3<Body> q, Vec3<Body> r) {
    builder.triangle(g, {p, q, r}, {p, q, r});
  };
  for (std::size_t octant = 0; octant < 8; ++octant) {
    Vec3<Body> a = tips[octant & 1 ? 3 : 0], b = tips[octant & 2 ? 4 : 1],
               c = tips[octant & 4 ? 5 : 2];
    if (dot(cross(a, b), c) < 0)
      std::swap(b, c);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; i + j < n; ++j) {
        const Vec3<Body> p = corner(a, b, c, i, j), q = corner(a, b, c, i + 1, j),
                         r = corner(a, b, c, i, j + 1);
        add(p, q, r);
        if (i + j + 1 < n)
          add(q, corner(a, b, c, i + 1, j + 1), r);
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
