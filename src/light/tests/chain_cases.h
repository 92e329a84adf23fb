#pragma once
// What tests of chains share.

#include "light/tests/integrator_cases.h"

namespace umov::cases {

/// The first level alone: a test draws 16 k chains in a second or two.
inline IntegrationOptions by_chains(std::size_t bounces, double accuracy = 0.005) {
  IntegrationOptions out;
  out.max_points = 1u << 14;
  out.bounces = bounces;
  out.accuracy = accuracy;
  out.between = BetweenMethod::Chains;
  return out;
}

/// GGX with the Smith masking of each direction by itself.
inline Material rough(const std::string &index, double alpha) {
  Material out = interface_of(index, 1);
  out.distribution = {"ggx", {{"alpha", alpha}}, {}, {}, {}};
  out.shadowing = Shadowing::Separable;
  return out;
}

/// A rough dielectric over a body whose light is polarized as it leaves.
inline Material paint() {
  Material out = builtin_material("paper_spectralon").value();
  out.index = builtin_material("paper_asi").value().index;
  out.distribution = {"beckmann", {{"alpha", 0.4}}, {}, {}, {}};
  out.body->is_polarized = true;
  return out;
}
/// Brushed: its lobe has no form for the vector unit.
inline Material brushed() {
  Material out = interface_of("paper_al", 1);
  out.distribution = {"ashikhmin_shirley", {{"nu", 20}, {"nv", 60}}, {}, {}, {}};
  out.direction = Vec3<Body>{1, 0, 0};
  return out;
}

/// Directions into that corner.
inline Pose into_corner(std::uint64_t index) {
  const auto u = uniform4(11, 3, index);
  const auto w = uniform4(11, 4, index);
  return {normalized(Vec3<Body>{0.1 + u[0], 0.1 + u[1], 0.1 + u[2]}),
          normalized(Vec3<Body>{0.1 + w[0], 0.1 + w[1], 0.1 + w[2]})};
}

/// A floor, a wall and a second wall, their inner sides facing each other.
inline Mesh three_plates() {
  Mesh mesh = corner();
  const std::array<std::uint32_t, 3> none{no_index, no_index, no_index};
  mesh.groups.push_back("side");
  mesh.positions.push_back({1, 0, 1});
  mesh.triangles.push_back({{0, 1, 6}, none, 2, 2});
  mesh.triangles.push_back({{0, 6, 4}, none, 2, 2});
  return mesh;
}

/// Squares of the difference over its expected size, of I, Q, U, V.
inline void add_squares(const BandResult &a, const BandResult &b, std::array<double, 4> &to) {
  const auto square = [&](double Stokes<ScatteringPlane>::*part) {
    const double error = std::hypot(a.half_width.*part, b.half_width.*part) / 1.96,
                 z = (a.stokes.*part - b.stokes.*part) / error;
    return z * z;
  };
  to[0] += square(&Stokes<ScatteringPlane>::i);
  to[1] += square(&Stokes<ScatteringPlane>::q);
  to[2] += square(&Stokes<ScatteringPlane>::u);
  to[3] += square(&Stokes<ScatteringPlane>::v);
}

/// Bands of a pose go together and poses share their chains: a mean square of 2 is no wonder, one
/// that a wrong sign or factor gives is above 100.
inline constexpr double most_square = 2.5;

} // namespace umov::cases
