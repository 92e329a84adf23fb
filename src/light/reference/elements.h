#pragma once
// Private: the surface of a scene cut into elements over which the shading normal turns little.

#include <array>
#include <atomic>
#include <cstdint>
#include <umov/scene/scene.h>
#include <vector>

namespace umov {

/// How far above a face its rays start, in parts of the size of the body.
inline constexpr double ray_offset = 1e-5;

/// A triangle of the mesh, or a piece of one. A point is a pair (u, v): a + u (b-a) + v (c-a) in
/// the mesh triangle a, b, c.
struct Element {
  std::array<Vec3<Body>, 3> normal;            ///< unit shading normals at the corners
  std::array<std::array<double, 2>, 3> corner; ///< (u, v) of the corners
  double area_m2 = 0;                          ///< of the curved surface where normals are smooth
  std::uint32_t triangle = 0;
  bool is_flat = true; ///< one normal all over
  /// How far the normal turns over it, and may turn over what is lit as one [rad].
  float turn_rad = 0, turn_max_rad = 0;
};

/// What each side of a triangle is: a slot is a mesh group with the front or back surface of it.
struct SideSlots {
  std::uint32_t front = no_index, back = no_index; ///< no_index: nothing can see this side
};

/// Slot number of a group; `is_back_surface` where the group's back material is meant.
constexpr std::uint32_t slot_of(std::uint32_t group, bool is_back_surface) {
  return 2 * group + (is_back_surface ? 1 : 0);
}
constexpr std::uint32_t group_of_slot(std::uint32_t slot) { return slot / 2; }
inline const Surface &surface_of_slot(const Scene &scene, std::uint32_t slot) {
  return (slot % 2 == 0 ? scene.front : scene.back)[slot / 2];
}

struct Elements {
  std::vector<Element> list;      ///< in the order of the mesh
  std::vector<SideSlots> slots;   ///< per mesh triangle
  std::vector<Vec3<Body>> normal; ///< per mesh triangle: unit geometric normal
  double size_m = 0;              ///< diagonal of the bounding box
};

/// Largest turn of the normal over one element, in standard deviations of the lobe's slope.
inline constexpr double element_turn_in_lobes = 1.0;
/// The same for broad lobes [rad]: the body lobe and the terminator vary on this scale.
inline constexpr double element_turn_max_rad = 0.09;

/// Elements are not cut finer than this [rad] before the pose is known: a lobe narrower than that
/// lights few of them, which are cut further then.
inline constexpr double element_turn_min_rad = 0.02;

/// Throws Failure (Interrupted) once `cancel`, which may be null, became true.
Elements make_elements(const Scene &scene, const std::vector<VisibleSides> &sides,
                       const std::atomic<bool> *cancel = nullptr);

/// Shading normal at barycentric weights of the element's corners; not normalised if flat.
inline Vec3<Body> shading_normal(const Element &e, double b0, double b1, double b2) {
  if (e.is_flat)
    return e.normal[0];
  return normalized(e.normal[0] * b0 + e.normal[1] * b1 + e.normal[2] * b2);
}

} // namespace umov
