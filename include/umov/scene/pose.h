#pragma once
// How an object is lit and seen: the only place that knows what a pose, its scattering plane and
// its phase are.

#include <algorithm>
#include <cmath>
#include <optional>
#include <umov/core/quantity.h>
#include <umov/core/vec3.h>

namespace umov {

/// Directions from the object, unit vectors in the body frame.
struct Pose {
  Vec3<Body> sun, observer;
  double sun_radius_rad = 0; ///< of the Sun's uniform disk; 0: a point
};

/// The direction of a vector of any length, however long or short; none of 0 and of what is not
/// finite. One that is of unit length within rounding stays as it is, so that the poses of a table
/// come back from it. Scaling by a power of two is exact: the bits do not depend on whether it is
/// done.
inline std::optional<Vec3<Body>> direction_along(Vec3<Body> v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0) || !std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
    return std::nullopt;
  if (std::abs(dot(v, v) - 1) < 4e-15)
    return v;
  if (largest > 1e-100 && largest < 1e100)
    return normalized(v);
  int exponent = 0; // squares would leave the range of a double
  std::frexp(largest, &exponent);
  return normalized(Vec3<Body>{std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent),
                               std::ldexp(v.z, -exponent)});
}

/// Angular radius of the Sun's disk at 1 au [rad], where no distance is known (695,700 km over 1
/// au: 0.26656 deg; the conventions fix 0.2665).
inline constexpr double sun_radius_at_1au_rad = 0.2665 * pi / 180;

/// Cosine of the phase angle (Sun-object-observer), within [-1, 1].
inline double cos_phase(const Pose &pose) {
  return std::clamp(dot(pose.sun, pose.observer), -1.0, 1.0);
}

/// There is a scattering plane, and so a Q and a U: Sun and observer are not in line. Below 1e-14
/// the normal v x l of the plane is rounding of the two unit vectors; Q of one reflection, which
/// goes with the square of the angle from there, is 0 to all digits.
inline bool has_scattering_plane(const Pose &pose) {
  return norm(cross(pose.observer, pose.sun)) > 1e-14;
}

} // namespace umov
