#pragma once
// Shapes that `umov mesh make` makes: closed, outward wound, with honest group names.

#include <umov/shape/mesh.h>

namespace umov {

/// Sphere about the origin as a geodesic grid; at least `facets` triangles, exact vertex normals.
Mesh make_sphere(double radius_m, std::size_t facets);
/// Square or rectangular sheet in the plane z = 0, normal +z, groups "front" and "back" if
/// `two_sided`, else one group "plate".
Mesh make_plate(double width_m, double height_m, bool two_sided);
/// Square sheet of multi-layer insulation about the origin, groups "front" (+z) and "back": flat,
/// or torn off: curled by 2.5 rad about y, front inwards, and crumpled into Gaussian folds of that
/// rms slope per axis (an eighth of the side long; at most 3).
Mesh make_mli_sheet(double side_m, double crumple_slope);
/// Closed cylinder along z centred at the origin; groups "side" and "caps"; side normals radial.
Mesh make_cylinder(double radius_m, double length_m, std::size_t sides);
/// Cube with edge and corner chamfers; group "cube".
Mesh make_chamfered_cube(double edge_m, double chamfer_m);
/// Ellipsoid with semi-axes a, b, c along x, y, z, exact vertex normals; group "cigar".
Mesh make_ellipsoid(double a_m, double b_m, double c_m, std::size_t facets);
/// Hubble Space Telescope from published dimensions (data/mesh/README.md). +z along the boresight,
/// origin at the middle of the tube, wings along x. Groups: light_shield, baffle (its inside),
/// forward_shell, equipment, aft_shroud, door, array_front, array_back, array_frame, antenna,
/// handrail.
struct HstOptions {
  double array_angle_rad = 0; ///< both wings about their boom (x); 0: cells face +z
  double door_angle_rad = 105 * 3.14159265358979323846 / 180; ///< 0: closed
  std::size_t sides = 48;
};
/// The telescope as its options say.
Mesh make_hst(const HstOptions &options = {});
/// Agena D upper stage from published overall dimensions; +z forward, z = 0 the nozzle exit.
struct AgenaOptions {
  std::size_t sides = 48;
};
/// The stage as its options say.
Mesh make_agena(const AgenaOptions &options = {});
/// A CubeSat by the CubeSat Design Specification (100 mm across, 113.5 mm per unit in height; 6 and
/// 12 units stand three high), origin at its middle, height along z. Groups: body_px, body_mx,
/// body_py, body_my, body_pz, body_mz, and for each panel panel_px_front (cells, +z), _back, _edge.
struct CubesatOptions {
  std::size_t units = 3;  ///< 1, 2, 3, 6 or 12
  std::size_t panels = 0; ///< 0 to 4 deployed ones as long as the body: to +x, -x, +y, -y
};
/// The CubeSat as its options say.
Mesh make_cubesat(const CubesatOptions &options = {});
/// A box with two wings along y. Groups: bus_px to bus_mz; wing_py_front (cells, +z), wing_py_back,
/// wing_py_edge, wing_py_yoke and the same for wing_my: each wing turns about y.
struct SatelliteOptions {
  Vec3<Body> bus_m{2, 2, 2.5};
  double wing_length_m = 8, wing_width_m = 2.2; ///< along y and across
  double yoke_m = 0.5;                          ///< from bus to wing
};
/// The satellite as its options say.
Mesh make_satellite(const SatelliteOptions &options = {});
/// A spent stage, z forward from the nozzle's exit. Groups: nozzle, aft, tank, forward.
struct RocketBodyOptions {
  double length_m = 6.5, diameter_m = 2; ///< without the nozzle
  double nozzle_length_m = 1, nozzle_diameter_m = 0.8;
  std::size_t sides = 48;
};
/// The stage as its options say.
Mesh make_rocket_body(const RocketBodyOptions &options = {});
/// A paraboloid shell opening to +z, its apex at the origin. Groups: dish_front, dish_back.
struct DishOptions {
  double diameter_m = 2, focus_m = 0.8;
  std::size_t sides = 48;
};
/// The dish as its options say.
Mesh make_dish(const DishOptions &options = {});
/// The benchmark's satellite: bus, two panels on yokes, dish (a shell), tower and tank, 4.2 m
/// across, at least `facets` triangles, most of them dividing flat faces. Groups: bus, panels,
/// dish, tank.
struct BoxWingOptions {
  std::size_t facets = 10'000;
  double crumple_m = 0; ///< height of the folds of the bus's foil; 0: flat faces
};
/// The satellite as its options say.
Mesh make_box_wing(const BoxWingOptions &options = {});

} // namespace umov
