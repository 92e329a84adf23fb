#pragma once
// Attitudes: even grids over all of them, small turns, distances.

#include <umov/core/rotation.h>
#include <vector>

namespace umov {

/// `count` attitudes spread evenly over SO(3): super-Fibonacci spirals (Alexa 2022, CVPR,
/// "Super-Fibonacci Spirals: Fast, Low-Discrepancy Sampling of SO(3)").
std::vector<Quaternion> attitude_grid(std::size_t count);
/// Angle [rad] within which a grid of `count` attitudes has a neighbour: the cube root of a cell's
/// volume (3.7 deg for 300,000).
double grid_spacing_rad(std::size_t count);

/// First a, then b: Hamilton's product a b.
Quaternion product(Quaternion a, Quaternion b);
/// The attitude turned by a rotation vector in body axes [rad].
Quaternion turned(Quaternion attitude, Vec3<Body> by);
/// The rotation vector in body axes [rad], at most pi long, that turns `from` into `to`.
Vec3<Body> turn_between(Quaternion from, Quaternion to);
/// Angle between two attitudes [rad], 0 to pi.
double angle_between(Quaternion a, Quaternion b);
/// Share of SO(3) within an angle [rad] of an attitude: (r - sin r) / pi.
double share_within(double radius_rad);

} // namespace umov
