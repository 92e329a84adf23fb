// Satellites and rocket bodies of given sizes, with a group for each face that differs.

#include <umov/shape/primitives.h>

#include "shape/mesh_builder.h"

#include <algorithm>

namespace umov {
namespace {

constexpr double gap_m = 1e-3; ///< between parts, so that no faces lie in one another

/// A closed box with a group for each face, named `name` + _px, _mx, _py, _my, _pz, _mz.
void add_named_box(MeshBuilder &builder, Vec3<Body> centre, Vec3<Body> half,
                   const std::string &name) {
  const auto p = [&](double x, double y, double z) {
    return centre + Vec3<Body>{x * half.x, y * half.y, z * half.z};
  };
  const auto face = [&](const char *suffix, const std::vector<Vec3<Body>> &corners) {
    builder.flat(builder.group(name + suffix), corners);
  };
  face("_px", {p(1, -1, -1), p(1, 1, -1), p(1, 1, 1), p(1, -1, 1)});
  face("_mx", {p(-1, 1, -1), p(-1, -1, -1), p(-1, -1, 1), p(-1, 1, 1)});
  face("_py", {p(1, 1, -1), p(-1, 1, -1), p(-1, 1, 1), p(1, 1, 1)});
  face("_my", {p(-1, -1, -1), p(1, -1, -1), p(1, -1, 1), p(-1, -1, 1)});
  face("_pz", {p(-1, -1, 1), p(1, -1, 1), p(1, 1, 1), p(-1, 1, 1)});
  face("_mz", {p(-1, 1, -1), p(1, 1, -1), p(1, -1, -1), p(-1, -1, -1)});
}

/// A thin panel whose cells face +z: groups NAME_front, NAME_back, NAME_edge.
void add_panel(MeshBuilder &builder, Vec3<Body> centre, Vec3<Body> half, const std::string &name) {
  Placement place;
  place.origin = centre;
  builder.box(half, place, builder.group(name + "_front"), builder.group(name + "_back"),
              builder.group(name + "_edge"));
}

/// A closed cylinder from a point along +y or -y.
void add_rod(MeshBuilder &builder, Vec3<Body> from, double side, double length, double radius,
             std::uint32_t group) {
  Placement place{from, {0, 0, side}, {1, 0, 0}, {0, side, 0}};
  builder.cylinder(radius, length, 12, place, group);
}

/// Outline of a paraboloid shell, from its apex up the back to the rim and down the bowl.
std::vector<Outline> bowl(const DishOptions &o, std::size_t rings, std::size_t &back_segments) {
  constexpr double wall = 0.01; // of the diameter
  const double thick = wall * o.diameter_m;
  const auto height = [&](double r) { return r * r / (4 * o.focus_m); };
  std::vector<Outline> out;
  for (std::size_t i = 0; i <= rings; ++i) {
    const double r = 0.5 * o.diameter_m * static_cast<double>(i) / static_cast<double>(rings);
    out.push_back({height(r) - thick, r});
  }
  back_segments = rings;
  for (std::size_t i = 0; i <= rings; ++i) {
    const double r =
        0.5 * o.diameter_m * static_cast<double>(rings - i) / static_cast<double>(rings);
    out.push_back({height(r), r});
  }
  return out;
}

} // namespace

Mesh make_cubesat(const CubesatOptions &options) {
  MeshBuilder builder;
  constexpr double unit = 0.1; // CubeSat Design Specification: 100 mm, 113.5 mm per unit in height
  constexpr double per_unit = 0.1135;
  const std::size_t units = options.units;
  // 6 and 12 units are two or four columns of three.
  const double x = units >= 6 ? 2 * unit : unit, y = units >= 12 ? 2 * unit : unit;
  const double z = per_unit * static_cast<double>(units >= 6 ? 3 : units);
  add_named_box(builder, {}, {x / 2, y / 2, z / 2}, "body");
  constexpr double thick = 0.0016; // of a printed board
  for (std::size_t k = 0; k < options.panels; ++k) {
    const double side = k % 2 == 0 ? 1 : -1;
    const bool is_along_x = k < 2;
    const double reach = is_along_x ? x / 2 : y / 2;
    const Vec3<Body> out = is_along_x ? Vec3<Body>{side, 0, 0} : Vec3<Body>{0, side, 0};
    // Hinged at the top of the body, as long as it is tall: cells up.
    const Vec3<Body> centre = out * (reach + gap_m + z / 2) + Vec3<Body>{0, 0, z / 2 - thick};
    const Vec3<Body> half =
        is_along_x ? Vec3<Body>{z / 2, y / 2, thick / 2} : Vec3<Body>{x / 2, z / 2, thick / 2};
    constexpr const char *names[] = {"panel_px", "panel_mx", "panel_py", "panel_my"};
    add_panel(builder, centre, half, names[k]);
  }
  return std::move(builder.mesh);
}

Mesh make_satellite(const SatelliteOptions &o) {
  MeshBuilder builder;
  add_named_box(builder, {}, o.bus_m * 0.5, "bus");
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "wing_py" : "wing_my";
    const double start = 0.5 * o.bus_m.y;
    const std::uint32_t yoke = builder.group(name + "_yoke");
    add_rod(builder, {0, side * (start + gap_m), 0}, side, o.yoke_m - 2 * gap_m,
            std::min(0.03, 0.1 * o.wing_width_m), yoke);
    add_panel(builder, {0, side * (start + o.yoke_m + 0.5 * o.wing_length_m), 0},
              {0.5 * o.wing_width_m, 0.5 * o.wing_length_m, 0.0125}, name);
  }
  return std::move(builder.mesh);
}

Mesh make_rocket_body(const RocketBodyOptions &o) {
  MeshBuilder builder;
  const std::uint32_t nozzle = builder.group("nozzle"), aft = builder.group("aft"),
                      tank = builder.group("tank"), forward = builder.group("forward");
  const double r = 0.5 * o.diameter_m, n = 0.5 * o.nozzle_diameter_m, z = o.nozzle_length_m;
  const double throat = 0.35 * n, dome = std::min(0.5 * r, 0.2 * o.length_m);
  // The nozzle is closed by a disk at its exit: what one sees of its inside is dark.
  const std::vector<Outline> outline{{0, 0},
                                     {0, n},
                                     {z, throat},
                                     {z, r},
                                     {z + o.length_m - dome, r},
                                     {z + o.length_m, 0.4 * r},
                                     {z + o.length_m, 0}};
  const std::vector<std::uint32_t> groups{nozzle, nozzle, aft, tank, forward, forward};
  builder.revolve(outline, o.sides, {}, [&](std::size_t i, std::size_t) { return groups[i]; });
  return std::move(builder.mesh);
}

Mesh make_dish(const DishOptions &options) {
  MeshBuilder builder;
  const std::uint32_t front = builder.group("dish_front"), back = builder.group("dish_back");
  std::size_t back_segments = 0;
  const auto outline = bowl(options, std::max<std::size_t>(4, options.sides / 4), back_segments);
  builder.revolve(outline, options.sides, {}, [&](std::size_t i, std::size_t) {
    return i <= back_segments ? back : front; // the rim belongs to the back
  });
  return std::move(builder.mesh);
}

} // namespace umov
