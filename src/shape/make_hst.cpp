// The Hubble Space Telescope from published dimensions; data/mesh/README.md has the source of each.

#include <umov/shape/primitives.h>

#include "shape/mesh_builder.h"

namespace umov {
namespace {

// Heights count from the aft end of the tube [m].
constexpr double total_length = 13.2;
constexpr double wide_radius = 4.27 / 2, narrow_radius = 3.05 / 2;
constexpr double shroud_top = 3.5, equipment_top = 5.02, shell_top = 8.98;
constexpr double wall = 0.05;        ///< of the light shield
constexpr double first_baffle = 9.6; ///< floor of the hollow light shield
constexpr double wing_height = 5.9;  ///< of the wings' axis
constexpr double wing_inner = 3.1, wing_width = 2.5, panel_length = 6.05;
constexpr double mid = total_length / 2; ///< the origin

void add_tube(MeshBuilder &b, std::size_t sides) {
  const std::uint32_t shroud = b.group("aft_shroud"), equipment = b.group("equipment"),
                      shell = b.group("forward_shell"), shield = b.group("light_shield"),
                      baffle = b.group("baffle");
  const std::vector<Outline> outline{{-mid, 0},
                                     {-mid, wide_radius},
                                     {shroud_top - mid, wide_radius},
                                     {equipment_top - mid, wide_radius},
                                     {equipment_top - mid, narrow_radius},
                                     {shell_top - mid, narrow_radius},
                                     {total_length - mid, narrow_radius},
                                     {total_length - mid, narrow_radius - wall},
                                     {first_baffle - mid, narrow_radius - wall},
                                     {first_baffle - mid, 0}};
  const std::vector<std::uint32_t> groups{shroud, shroud, equipment, equipment, shell,
                                          shield, shield, baffle,    baffle};
  b.revolve(outline, sides, {}, [&](std::size_t segment, std::size_t) { return groups[segment]; });
}

void add_door(MeshBuilder &b, std::size_t sides, double angle) {
  // Hinged at the rim on +y; 0 = closed. The hinge clears the rim by 3 cm.
  constexpr double thickness = 0.04, gap = 0.03;
  const Vec3<Body> hinge{0, narrow_radius + gap, total_length - mid + gap};
  // Opening turns the disk's centre, which lies at -y from the hinge, up towards +z.
  const Placement turned = turned_about_x(hinge, -angle);
  Placement place = turned;
  place.origin = turned.point({0, -(narrow_radius + gap), 0});
  b.cylinder(narrow_radius, thickness, sides, place, b.group("door"));
}

void add_wing(MeshBuilder &b, double side, double angle) {
  const std::uint32_t front = b.group("array_front"), back = b.group("array_back"),
                      frame = b.group("array_frame");
  const Placement axis = turned_about_x({0, 0, wing_height - mid}, angle);
  const double middle = side * (wing_inner + wing_width / 2);
  const auto at = [&](double x, double y, double z) {
    Placement place = axis;
    place.origin = axis.point({x, y, z});
    return place;
  };
  constexpr double boom = 0.07, bar = 0.03, gap = 0.08;
  for (const double half : {-1.0, 1.0}) // two blankets, one on each side of the boom
    b.box({wing_width / 2, panel_length / 2, 0.01}, at(middle, half * (panel_length / 2 + gap), 0),
          front, back, frame);
  for (const double edge : {-1.0, 1.0}) { // bars along both edges and at both ends
    b.box({bar, panel_length + gap + 0.1, bar},
          at(middle + edge * (wing_width / 2 + 2 * bar), 0, 0), frame, frame, frame);
    b.box({wing_width / 2 + 0.02, bar, bar}, at(middle, edge * (panel_length + gap + 2.5 * bar), 0),
          frame, frame, frame);
  }
  // The boom, from inside the tube to the outer bar, along x.
  Placement along{{side * 1.3, 0, wing_height - mid}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  if (side < 0)
    along = {along.origin, {0, 1, 0}, {0, 0, -1}, {-1, 0, 0}};
  b.cylinder(boom, wing_inner + wing_width + 0.3 - 1.3, 12, along, frame);
}

void add_antennas(MeshBuilder &b) {
  const std::uint32_t antenna = b.group("antenna");
  for (const double side : {-1.0, 1.0}) {
    // Mast along the forward shell, dish 1.3 m across at its end.
    b.cylinder(0.03, 4.4, 8, {{0.02 * side, side * (narrow_radius + 0.09), 5.7 - mid}}, antenna);
    Placement dish{
        {0, side * (narrow_radius + 0.16), 10.35 - mid}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    if (side < 0)
      dish = {dish.origin, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
    b.cylinder(0.65, 0.12, 24, dish, antenna);
  }
}

void add_handrails(MeshBuilder &b) {
  const std::uint32_t rail = b.group("handrail");
  constexpr int count = 12;
  for (int i = 0; i < count; ++i) {
    const double phi = 2 * pi * (i + 0.5) / count;
    const Vec3<Body> out{std::cos(phi), std::sin(phi), 0}, along{-std::sin(phi), std::cos(phi), 0};
    const Vec3<Body> centre = out * (wide_radius + 0.08) + Vec3<Body>{0, 0, 1.75 - mid};
    b.box({0.0175, 0.0175, 1.2}, {centre, out, along, {0, 0, 1}}, rail, rail, rail);
  }
}

} // namespace

Mesh make_hst(const HstOptions &options) {
  MeshBuilder builder;
  add_tube(builder, options.sides);
  add_door(builder, options.sides, options.door_angle_rad);
  for (const double side : {-1.0, 1.0})
    add_wing(builder, side, options.array_angle_rad);
  add_antennas(builder);
  add_handrails(builder);
  return builder.mesh;
}

} // namespace umov
