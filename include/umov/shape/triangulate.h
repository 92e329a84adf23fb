#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <umov/core/vec3.h>
#include <vector>

namespace umov {

/// Triangles of a polygon.
struct Triangulation {
  std::vector<std::array<std::uint32_t, 3>> triangles; ///< corners as indices into the polygon
  bool is_convex = true;
  bool is_simple = true; ///< false: the outline crosses itself; the triangles are a fan
  bool is_planar = true; ///< within 1e-3 of its size
};

/// Splits a polygon with three or more corners, convex or not, into triangles with its winding (ear
/// clipping: Meisters 1975; convex ones become a fan, halves of halves past 64 corners). n - 2
/// triangles always.
Triangulation triangulate(std::span<const Vec3<Body>> corners);

} // namespace umov
