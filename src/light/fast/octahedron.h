#pragma once
// Private: directions on the unfolded octahedron (Meyer et al. 2010, "On floating-point normal
// vectors"), and the grid over it.

#include "backend/octahedron.h"

#include <umov/core/vec3.h>

namespace umov {

using backend::SquarePoint;
SquarePoint octahedron_point(Vec3<Body> direction);
Vec3<Body> octahedron_direction(SquarePoint p);

/// Direction number `index` of a grid of cells x cells (row by row, (cells + 1)^2 of them).
Vec3<Body> grid_direction(std::size_t cells, std::size_t index);
/// The corners of the triangle of the grid that holds a direction, and barycentric weights. Cells
/// are cut along the octahedron's edges; `cells` must be even so that no cell crosses one.
backend::GridLook look_around(std::size_t cells, Vec3<Body> direction);
/// Sine of an angle that no corner of that triangle is further away than.
double grid_reach(std::size_t cells);

/// Order along a space-filling curve (Morton) over the square, 24 bits.
std::uint32_t curve_order(Vec3<Body> direction);

} // namespace umov
