#pragma once
// Which way the body points.

#include <memory>
#include <string>
#include <umov/core/result.h>
#include <umov/core/rotation.h>
#include <umov/time/epoch.h>
#include <variant>

namespace umov {

/// What an axis can be pointed at.
enum class Target { Nadir, Zenith, Velocity, OrbitNormal, Sun, Observer };
/// A fixed direction: right ascension and declination in GCRS.
struct CelestialDirection {
  double right_ascension_rad = 0, declination_rad = 0;
};
using Direction = std::variant<Target, CelestialDirection>;

/// `point` exactly at one direction, `then` as near as possible towards another.
struct TwoAxisLaw {
  Vec3<Body> point{0, 0, 1};
  Direction at = Target::Nadir;
  Vec3<Body> then{1, 0, 0};
  Direction toward = Target::Velocity;
};
/// Fixed among the stars.
struct InertialLaw {
  Quaternion body_from_gcrs;
};
/// Turns at a constant rate about a body axis, starting at `epoch` from another law's attitude,
/// which is frozen at that epoch. Positive: right-handed about the axis.
struct SpinLaw {
  std::variant<TwoAxisLaw, InertialLaw> start;
  Vec3<Body> axis{0, 0, 1};
  double rate_rad_s = 0;
  Epoch<Utc> epoch{};
};
using AttitudeLaw = std::variant<TwoAxisLaw, InertialLaw, SpinLaw>;

/// What a law may look at.
struct AttitudeContext {
  Epoch<Utc> time;
  Vec3<Gcrs> position_km, velocity_km_s; ///< inertial
  Vec3<Gcrs> to_sun, to_observer;        ///< unit vectors at the object
};

/// Attitude at a time. For a spin `at_epoch` is the context at the law's epoch (else unused).
/// Physics error if the two directions of a two-axis law are parallel within 1e-9 rad, or if a
/// direction has no length (no velocity). A quaternion is normalised; `check` judges its length.
/// Nadir is towards the Earth's centre; the orbit normal is position x velocity.
Result<Rotation<Body, Gcrs>> attitude_at(const AttitudeLaw &law, const AttitudeContext &now,
                                         const AttitudeContext &at_epoch);

/// Checks what a law says on its own: finite numbers, axes of a length, `point` and `then` not
/// parallel within 1e-9 rad, unit quaternion within 1e-6, a finite spin rate. BadInput otherwise.
Result<void> check(const AttitudeLaw &law);

/// A quaternion as the user gave it: normalised if within 1e-6 of unit length, else BadInput.
Result<Quaternion> unit_quaternion(Quaternion q);

} // namespace umov
