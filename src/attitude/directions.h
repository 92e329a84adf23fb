#pragma once
// Private: directions, two axes, and turns of the body.

#include <cmath>
#include <umov/attitude/attitude.h>
#include <umov/core/quantity.h>

namespace umov::attitude {

inline constexpr double parallel_rad = 1e-9;

template <class Frame> inline bool is_finite(Vec3<Frame> v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class Frame> inline bool are_parallel(Vec3<Frame> a, Vec3<Frame> b) {
  const double angle = angle_between(a, b);
  return !(angle > parallel_rad && angle < pi - parallel_rad);
}

/// For messages.
std::string describe(const Direction &direction);
Vec3<Gcrs> unit_vector(const CelestialDirection &star);

Result<Vec3<Gcrs>> unit_along(const Direction &direction, const AttitudeContext &context);

/// Without the law's offset.
Result<Rotation<Body, Gcrs>> two_axis(const TwoAxisLaw &law, const AttitudeContext &context);
Rotation<Body, Gcrs> inertial(const InertialLaw &law);
Rotation<Body, Body> offset_rotation(const AttitudeOffset &offset);
/// Components in a body turned by `angle` about `axis`, from those in the body before.
Rotation<Body, Body> turned(Vec3<Body> axis, double angle);
Result<Rotation<Body, Gcrs>> start_attitude(const StartLaw &start, const AttitudeContext &at);

} // namespace umov::attitude
