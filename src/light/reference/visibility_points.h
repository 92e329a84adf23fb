#pragma once
// Private: points on elements and where their rays start.

#include "light/reference/elements_lit.h"

#include <array>

namespace umov {

/// Barycentric (b1, b2) of a uniform point in cell `cell` of cuts^2 congruent ones; x, y in (0, 1).
std::array<double, 2> point_in_cell(std::size_t cuts, std::size_t cell, double x, double y);

/// Where the rays of a point start: on the face, lifted onto the curved surface that its vertex
/// normals describe (Hanika 2021, "Hacking the shadow terminator") and 1e-5 of the size further,
/// on the side that is seen.
Vec3<Body> ray_origin(const Scene &scene, const Elements &elements, const LitElement &lit,
                      const Element &e, std::array<double, 2> point);

} // namespace umov
