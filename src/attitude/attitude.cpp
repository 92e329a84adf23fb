// Attitude laws: docs/theory/attitude.md.

#include <array>
#include <cmath>
#include <umov/attitude/attitude.h>
#include <umov/core/quantity.h>
#include <umov/core/text.h>

namespace umov {

namespace {

constexpr double parallel_rad = 1e-9;

template <class Frame> bool is_finite(Vec3<Frame> v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class Frame> bool are_parallel(Vec3<Frame> a, Vec3<Frame> b) {
  const double angle = angle_between(a, b);
  return !(angle > parallel_rad && angle < pi - parallel_rad);
}

std::string describe(const Direction &direction) {
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

Vec3<Gcrs> along(const Direction &direction, const AttitudeContext &context) {
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

/// Components in a body turned by `angle` about `axis`, from those in the body before.
Rotation<Body, Body> turned(Vec3<Body> axis, double angle) {
  const Vec3<Body> n = normalized(axis);
  const double s = std::sin(angle / 2);
  return rotation_from<Body, Body>({std::cos(angle / 2), s * n.x, s * n.y, s * n.z});
}

Result<Rotation<Body, Gcrs>> spin(const SpinLaw &law, const AttitudeContext &now,
                                  const AttitudeContext &at_epoch) {
  Rotation<Body, Gcrs> start;
  if (const auto *two = std::get_if<TwoAxisLaw>(&law.start)) {
    UMOV_ASSIGN(frozen, two_axis(*two, at_epoch));
    start = frozen;
  } else {
    start = inertial(std::get<InertialLaw>(law.start));
  }
  const double turns = seconds_between(now.time, law.epoch) * (law.rate_rad_s / (2 * pi));
  return turned(law.axis, 2 * pi * (turns - std::floor(turns))) * start;
}

Result<void> check_axis(Vec3<Body> axis, const std::string &name) {
  const double length = norm(axis);
  if (is_finite(axis) && length > 0 && std::isfinite(length))
    return {};
  return fail(ErrorCode::BadInput, "the body axis \"" + name + "\" is (" + shortest(axis.x) + ", " +
                                       shortest(axis.y) + ", " + shortest(axis.z) +
                                       "), expected a finite vector that is not zero, as +Z.");
}

Result<void> check_direction(const Direction &direction, const std::string &name) {
  const auto *star = std::get_if<CelestialDirection>(&direction);
  if (!star)
    return {};
  if (std::isfinite(star->right_ascension_rad) && std::abs(star->declination_rad) <= pi / 2)
    return {};
  return fail(ErrorCode::BadInput, "\"" + name + "\" is " + describe(direction) +
                                       ", expected a finite right ascension and a declination "
                                       "of -90 to 90 deg.");
}

/// True for two targets that lie along one line at all times.
bool are_always_parallel(const Direction &a, const Direction &b) {
  const auto *one = std::get_if<Target>(&a), *other = std::get_if<Target>(&b);
  if (one && other)
    return (*one == Target::Zenith ? Target::Nadir : *one) ==
           (*other == Target::Zenith ? Target::Nadir : *other);
  const auto *star = std::get_if<CelestialDirection>(&a),
             *second = std::get_if<CelestialDirection>(&b);
  return star && second && are_parallel(unit_vector(*star), unit_vector(*second));
}

Result<void> check_law(const TwoAxisLaw &law) {
  UMOV_TRY(check_axis(law.point, "point"));
  UMOV_TRY(check_axis(law.then, "then"));
  UMOV_TRY(check_direction(law.at, "at"));
  UMOV_TRY(check_direction(law.toward, "toward"));
  if (are_always_parallel(law.at, law.toward))
    return fail(ErrorCode::BadInput, "\"at\" is " + describe(law.at) + " and \"toward\" is " +
                                         describe(law.toward) +
                                         ": they lie along one line at all times. Choose another "
                                         "\"toward\".");
  if (are_parallel(law.point, law.then))
    return fail(ErrorCode::BadInput,
                "the body axes \"point\" and \"then\" are parallel, expected two different axes. "
                "Choose another \"then\", as +X for point +Z.");
  return {};
}

Result<void> check_law(const InertialLaw &law) {
  UMOV_TRY(unit_quaternion(law.body_from_gcrs));
  return {};
}

Result<void> check_law(const SpinLaw &law) {
  UMOV_TRY(std::visit([](const auto &start) { return check_law(start); }, law.start));
  UMOV_TRY(check_axis(law.axis, "axis"));
  if (!std::isfinite(law.rate_rad_s))
    return fail(ErrorCode::BadInput, "the spin rate is " + shortest(law.rate_rad_s) +
                                         ", expected a finite number of radians per second.");
  return {};
}

} // namespace

Result<Rotation<Body, Gcrs>> attitude_at(const AttitudeLaw &law, const AttitudeContext &now,
                                         const AttitudeContext &at_epoch) {
  if (const auto *two = std::get_if<TwoAxisLaw>(&law))
    return two_axis(*two, now);
  if (const auto *fixed = std::get_if<InertialLaw>(&law))
    return inertial(*fixed);
  return spin(std::get<SpinLaw>(law), now, at_epoch);
}

Result<void> check(const AttitudeLaw &law) {
  return std::visit([](const auto &l) { return check_law(l); }, law);
}

Result<Quaternion> unit_quaternion(Quaternion q) {
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(std::abs(length - 1) <= 1e-6))
    return fail(ErrorCode::BadInput,
                "the quaternion has length " + shortest(length) +
                    ", expected 1 within 1e-6 (scalar first: w, x, y, z). Give more digits or "
                    "divide by its length.");
  return Quaternion{q.w / length, q.x / length, q.y / length, q.z / length};
}

} // namespace umov
