// What a law says on its own.

#include "attitude/directions.h"

#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {

namespace {

using attitude::are_parallel, attitude::describe, attitude::is_finite, attitude::unit_vector;

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
  if (!star) // places have been checked where they were made
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

Result<void> check_start(const StartLaw &start) {
  return std::visit([](const auto &law) { return check_law(law); }, start);
}

Result<void> check_law(const SpinLaw &law) {
  UMOV_TRY(check_start(law.start));
  UMOV_TRY(check_axis(law.axis, "axis"));
  if (!std::isfinite(law.rate_rad_s))
    return fail(ErrorCode::BadInput, "the spin rate is " + shortest(law.rate_rad_s) +
                                         ", expected a finite number of radians per second.");
  return {};
}

Result<void> check_law(const TumbleLaw &law) {
  UMOV_TRY(check_start(law.start));
  if (!is_finite(law.rate_rad_s))
    return fail(ErrorCode::BadInput, "the angular velocity is not finite");
  if (!law.from_mesh)
    UMOV_TRY(principal_axes(law.inertia));
  return {};
}

Result<void> check_law(const TableLaw &law) {
  if (law.table)
    UMOV_TRY(check_attitude_table(*law.table));
  return {};
}

Result<void> check_law(const PiecewiseLaw &law) {
  if (law.pieces.empty())
    return fail(ErrorCode::BadInput, "an attitude of pieces has none");
  for (std::size_t k = 0; k < law.pieces.size(); ++k) {
    UMOV_TRY(check_attitude(*law.pieces[k].law));
    if (k > 0 && !(seconds_between(law.pieces[k].from, law.pieces[k - 1].from) > 0))
      return fail(ErrorCode::BadInput,
                  fmt::format("the piece from {} follows that from {}, expected a later time",
                              to_iso(law.pieces[k].from), to_iso(law.pieces[k - 1].from)));
  }
  return {};
}

Result<void> check_law(const LibrationLaw &law) {
  UMOV_TRY(check_attitude(*law.law));
  if (!(law.rms_rad >= 0 && law.rms_rad <= 0.5))
    return fail(ErrorCode::BadInput, "the libration is " +
                                         degrees_text(Angle::radians(law.rms_rad)) +
                                         " deg, expected 0 to 28 deg");
  if (!(law.period_s > 0 && std::isfinite(law.period_s)))
    return fail(ErrorCode::BadInput, "the period of the libration is " + shortest(law.period_s) +
                                         " s, expected a positive number");
  return {};
}

} // namespace

Result<void> check_attitude(const AttitudeLaw &law) {
  return std::visit([](const auto &one) { return check_law(one); }, law);
}

Result<Quaternion> unit_quaternion(Quaternion q) {
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(std::abs(length - 1) <= 1e-6))
    return fail(ErrorCode::BadInput,
                "the quaternion has length " + shortest(length) +
                    ", expected 1 within 1e-6 (scalar first: w, x, y, z). Give more digits or "
                    "divide by its length.");
  if (std::abs(length - 1) < 1e-15) // left alone, so that writing and reading change nothing
    return q;
  return Quaternion{q.w / length, q.x / length, q.y / length, q.z / length};
}

} // namespace umov
