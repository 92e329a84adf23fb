#include <umov/shape/primitives.h>
#include <umov/shape/rough_surface.h>

#include "shape/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace umov {
namespace {

using Ring = std::vector<Vec3<Body>>;

/// Points on the unit sphere in rings of equal latitude steps, each with as many as its length
/// holds at an even spacing; every ring is turned by the golden ratio against the one before, so
/// that no pattern repeats. `spacing`: between neighbours [rad].
std::vector<Ring> rings_of_points(double spacing) {
  // Rows of equilateral triangles stand sqrt(3)/2 apart; a little more (found by trial: errors of a
  // glint between neighbouring rings are smallest there) and a little closer along the ring.
  constexpr double stretch = 1.05, golden = 0.61803398874989485;
  const double height = spacing * stretch * std::sqrt(3.0) / 2;
  const auto count = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(pi / height)));
  std::vector<Ring> rings;
  for (std::size_t i = 0; i <= count; ++i) {
    const double theta = pi * static_cast<double>(i) / static_cast<double>(count);
    if (i == 0 || i == count) {
      rings.push_back({{0, 0, i == 0 ? 1.0 : -1.0}});
      continue;
    }
    const auto sides = std::max<std::size_t>(
        4, static_cast<std::size_t>(std::lround(2 * pi * std::sin(theta) * stretch / spacing)));
    Ring ring;
    for (std::size_t j = 0; j < sides; ++j) {
      const double phi = 2 * pi * (static_cast<double>(j) + golden * static_cast<double>(i)) /
                         static_cast<double>(sides);
      ring.push_back(
          {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

/// Closes the band between two rings with triangles of the convex hull: of the two that can follow
/// an edge, the one whose plane has the other's corner below it.
template <class Add> void close_band(const Ring &upper, const Ring &lower, Add add) {
  const std::size_t n = upper.size(), m = lower.size();
  std::size_t start = 0; // the nearest neighbour: an edge to it is in the hull
  for (std::size_t j = 1; j < m; ++j)
    if (norm(lower[j] - upper[0]) < norm(lower[start] - upper[0]))
      start = j;
  const std::size_t upper_steps = n == 1 ? 0 : n, lower_steps = m == 1 ? 0 : m;
  for (std::size_t x = 0, y = 0; x < upper_steps || y < lower_steps;) {
    const Vec3<Body> a = upper[x % n], next_a = upper[(x + 1) % n];
    const Vec3<Body> c = lower[(start + y) % m], next_c = lower[(start + y + 1) % m];
    const bool is_hull = dot(cross(c - a, next_a - a), next_c - a) <= 0;
    const bool step_upper = y == lower_steps || (x < upper_steps && is_hull);
    add(a, c, step_upper ? next_a : next_c);
    ++(step_upper ? x : y);
  }
}

/// Unit sphere with at least `facets` triangles of like size and its corners on the sphere.
Mesh unit_sphere(std::size_t facets, const std::string &group) {
  MeshBuilder builder;
  const std::uint32_t g = builder.group(group);
  // Twice as many triangles as points; a point takes sqrt(3)/2 spacing^2 of the sphere.
  double spacing = std::sqrt(4 * pi * 2 / static_cast<double>(facets) * 2 / std::sqrt(3.0));
  std::vector<Ring> rings;
  for (;; spacing *= 0.998) {
    rings = rings_of_points(spacing);
    std::size_t points = 0;
    for (const Ring &ring : rings)
      points += ring.size();
    if (2 * points - 4 >= facets) // Euler
      break;
  }
  for (std::size_t i = 0; i + 1 < rings.size(); ++i)
    close_band(rings[i], rings[i + 1], [&](Vec3<Body> p, Vec3<Body> q, Vec3<Body> r) {
      builder.triangle(g, {p, q, r}, {p, q, r});
    });
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

Mesh make_mli_sheet(double side_m, double crumple_slope) {
  if (!(crumple_slope > 0))
    return make_plate(side_m, side_m, true);
  constexpr std::size_t cells = 64;
  const auto field = make_height_field({.cells = cells,
                                        .cell_m = side_m / cells,
                                        .slope = std::min(crumple_slope, 3.0),
                                        .correlation_cells = cells / 8.,
                                        .hurst = 0,
                                        .seed = 1});
  Mesh out = mesh_of(*field); // its options are in range
  // A height field never shows its back from the front; a curled one does.
  constexpr double curl = 2.5; // rad from edge to edge
  const double radius = side_m / curl;
  for (Vec3<Body> &p : out.positions) {
    const double angle = (p.x - side_m / 2) / radius, r = radius - p.z;
    p = {r * std::sin(angle), p.y - side_m / 2, radius / 2 - r * std::cos(angle)};
  }
  out.groups = {"front", "back"};
  for (Triangle &t : out.triangles) {
    t.front = 0;
    t.back = 1;
  }
  return out;
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
