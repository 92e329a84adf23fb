#include "attitude/directions.h"

#include <array>
#include <umov/core/text.h>
#include <umov/frames/earth.h>

namespace umov::attitude {

std::string describe(const Direction &direction) {
  if (const auto *ground = std::get_if<GroundTarget>(&direction))
    return "the place at latitude " + degrees_text(ground->site.latitude) + " deg, longitude " +
           degrees_text(ground->site.longitude) + " deg";
  if (const auto *star = std::get_if<CelestialDirection>(&direction))
    return "the direction ra " + degrees_text(Angle::radians(star->right_ascension_rad)) +
           " deg, dec " + degrees_text(Angle::radians(star->declination_rad)) + " deg";
  switch (std::get<Target>(direction)) {
  case Target::Nadir:
    return "nadir";
  case Target::Zenith:
    return "zenith";
  case Target::Velocity:
    return "velocity";
  case Target::OrbitNormal:
    return "orbit_normal";
  case Target::Sun:
    return "sun";
  case Target::Observer:
    return "observer";
  }
  return "an unknown target";
}

Vec3<Gcrs> unit_vector(const CelestialDirection &star) {
  const double c = std::cos(star.declination_rad);
  return {c * std::cos(star.right_ascension_rad), c * std::sin(star.right_ascension_rad),
          std::sin(star.declination_rad)};
}

namespace {

Vec3<Gcrs> along(const Direction &direction, const AttitudeContext &context) {
  if (const auto *ground = std::get_if<GroundTarget>(&direction))
    return itrs_from_gcrs(context.time).inverse() * itrs_position_km(ground->site) -
           context.position_km;
  if (const auto *star = std::get_if<CelestialDirection>(&direction))
    return unit_vector(*star);
  switch (std::get<Target>(direction)) {
  case Target::Nadir:
    return -context.position_km;
  case Target::Zenith:
    return context.position_km;
  case Target::Velocity:
    return context.velocity_km_s;
  case Target::OrbitNormal:
    return cross(context.position_km, context.velocity_km_s);
  case Target::Sun:
    return context.to_sun;
  case Target::Observer:
    return context.to_observer;
  }
  return {};
}

/// Axes of a frame with x exactly along `first` and z perpendicular to both.
template <class Frame> std::array<Vec3<Frame>, 3> triad(Vec3<Frame> first, Vec3<Frame> second) {
  const Vec3<Frame> x = normalized(first);
  const Vec3<Frame> rough = normalized(cross(x, normalized(second)));
  // Once more: near-parallel vectors leave `rough` off the perpendicular by rounding.
  const Vec3<Frame> z = normalized(rough - x * dot(x, rough));
  return {x, cross(z, x), z};
}

} // namespace

Result<Vec3<Gcrs>> unit_along(const Direction &direction, const AttitudeContext &context) {
  const Vec3<Gcrs> v = along(direction, context);
  const double length = norm(v);
  if (!(length > 0 && std::isfinite(length)))
    return fail(ErrorCode::Physics, describe(direction) +
                                        " has no direction at that time; choose another target "
                                        "for the attitude.");
  return v / length;
}

// The attitude takes the triad of the body axes to the triad of the directions (Black 1964).
Result<Rotation<Body, Gcrs>> two_axis(const TwoAxisLaw &law, const AttitudeContext &context) {
  UMOV_ASSIGN(at, unit_along(law.at, context));
  UMOV_ASSIGN(toward, unit_along(law.toward, context));
  if (are_parallel(at, toward))
    return fail(ErrorCode::Physics,
                describe(law.at) + " and " + describe(law.toward) +
                    " are parallel at that time, expected two different directions; the turn "
                    "about the pointed axis is free. Choose another \"toward\".");
  const auto body = triad(law.point, law.then);
  const auto sky = triad(at, toward);
  // Row i: body axis i in GCRS components, sum over k of (body_k)_i sky_k.
  const auto row = [&](double a, double b, double c) {
    return sky[0] * a + sky[1] * b + sky[2] * c;
  };
  return Rotation<Body, Gcrs>(row(body[0].x, body[1].x, body[2].x),
                              row(body[0].y, body[1].y, body[2].y),
                              row(body[0].z, body[1].z, body[2].z));
}

Rotation<Body, Gcrs> inertial(const InertialLaw &law) {
  const Quaternion &q = law.body_from_gcrs;
  const double n = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return rotation_from<Body, Gcrs>({q.w / n, q.x / n, q.y / n, q.z / n});
}

Rotation<Body, Body> turned(Vec3<Body> axis, double angle) {
  const Vec3<Body> n = normalized(axis);
  const double s = std::sin(angle / 2);
  return rotation_from<Body, Body>({std::cos(angle / 2), s * n.x, s * n.y, s * n.z});
}

Rotation<Body, Body> offset_rotation(const AttitudeOffset &o) {
  if (o.roll_rad == 0 && o.pitch_rad == 0 && o.yaw_rad == 0)
    return {};
  return turned({1, 0, 0}, o.roll_rad) * turned({0, 1, 0}, o.pitch_rad) *
         turned({0, 0, 1}, o.yaw_rad);
}

Result<Rotation<Body, Gcrs>> start_attitude(const StartLaw &start, const AttitudeContext &at) {
  if (const auto *two = std::get_if<TwoAxisLaw>(&start)) {
    UMOV_ASSIGN(frozen, two_axis(*two, at));
    return offset_rotation(two->offset) * frozen;
  }
  return inertial(std::get<InertialLaw>(start));
}

} // namespace umov::attitude
