#pragma once
// How an object is lit and seen: the only place that knows what a pose, its scattering plane and
// its phase are.

#include <algorithm>
#include <umov/core/quantity.h>
#include <umov/core/vec3.h>

namespace umov {

/// Directions from the object, unit vectors in the body frame.
struct Pose {
  Vec3<Body> sun, observer;
  double sun_radius_rad = 0; ///< of the Sun's uniform disk; 0: a point
};

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
