#include "inverse/turning_step.h"

#include <algorithm>
#include <cmath>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

bool has_axis(const Turning &turning, double span_s) {
  return norm(turning.rate_rad_s) * span_s > 1;
}

double sinc(double x) { return std::abs(x) > 1e-6 ? std::sin(x) / x : 1; }

Vec3<Body> part(const Step &step, Eigen::Index first) {
  return {step[first], step[first + 1], step[first + 2]};
}

/// A vector in what lies along an axis and across it.
struct Split {
  double along = 0;
  Vec3<Body> across;
};

Split split(const Vec3<Body> &v, const Vec3<Body> &axis) {
  const double along = dot(v, axis);
  return {along, v - axis * along};
}

/// Turns a unit vector by a rotation vector across it.
Vec3<Body> tilted(const Vec3<Body> &axis, const Vec3<Body> &by) {
  const double angle = norm(by);
  return axis * std::cos(angle) + cross(by, axis) * sinc(angle);
}

/// Some unit vector across another.
Vec3<Body> any_across(const Vec3<Body> &v) {
  return normalized(std::abs(v.x) < 0.6 ? cross(v, {1, 0, 0}) : cross(v, {0, 1, 0}));
}

/// The shortest rotation vector that turns one unit vector into another; one of them where they
/// point opposite ways.
Vec3<Body> tilt_between(const Vec3<Body> &from, const Vec3<Body> &to) {
  const Vec3<Body> normal = cross(from, to);
  const double sine = norm(normal);
  if (sine > 0)
    return normal * (angle_between(from, to) / sine);
  return dot(from, to) < 0 ? any_across(from) * pi : Vec3<Body>{0, 0, 0};
}

/// The vector of a turn that is a tilt across the axis after a turn about it.
Vec3<Body> tilt_and_roll(const Quaternion &from, const Quaternion &to, const Vec3<Body> &axis) {
  const Quaternion d = product({from.w, -from.x, -from.y, -from.z}, to);
  const double roll = 2 * std::atan2(d.x * axis.x + d.y * axis.y + d.z * axis.z, d.w);
  const double turn = std::remainder(roll, 2 * pi);
  return turn_between(from, turned(to, axis * -turn)) + axis * turn;
}

/// Derivatives of rotation vector and rate with the six numbers of a step (`is_back`: the other way
/// round), about no step.
Matrix6 by_step(const Turning &about, double span_s, bool is_back) {
  Matrix6 out = Matrix6::Identity();
  const double rate = norm(about.rate_rad_s), along_s = is_back ? span_s : 1 / span_s;
  if (!has_axis(about, span_s)) {
    out.bottomRightCorner<3, 3>() *= along_s;
    return out;
  }
  const Eigen::Vector3d u = eigen_of(about.rate_rad_s) / rate;
  const Eigen::Matrix3d along = u * u.transpose(), all = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d cross_u; // cross_u v = u x v
  cross_u << 0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0;
  const Eigen::Matrix3d across = is_back ? Eigen::Matrix3d(cross_u / rate) : cross_u * -rate;
  out.topRightCorner<3, 3>() = is_back ? across : Eigen::Matrix3d(along - all);
  out.bottomRightCorner<3, 3>() = along * along_s + across;
  return out;
}

/// A covariance by derivatives of its six numbers; of an attitude's three, as it is.
Eigen::MatrixXd carried(const Eigen::MatrixXd &covariance, const Turning &about, double span_s,
                        bool is_back) {
  if (covariance.rows() < 6)
    return covariance;
  const Matrix6 by = by_step(about, span_s, is_back);
  return by * covariance * by.transpose();
}

} // namespace

Turning stepped(const Turning &from, const Step &step, double span_s) {
  if (step.size() < 6)
    return {turned(from.attitude, part(step, 0)), from.rate_rad_s};
  if (!has_axis(from, span_s))
    return {turned(from.attitude, part(step, 0)), from.rate_rad_s + part(step, 3) * (1 / span_s)};
  const double rate = norm(from.rate_rad_s);
  const Vec3<Body> axis = from.rate_rad_s * (1 / rate);
  const auto [roll, tilt] = split(part(step, 0), axis);
  const auto [faster, mounting] = split(part(step, 3), axis);
  const Quaternion spun = turned(turned(from.attitude, tilt), axis * roll);
  return {turned(spun, mounting * -1), tilted(axis, mounting) * (rate + faster / span_s)};
}

Step step_between(const Turning &from, const Turning &to, Eigen::Index size, double span_s) {
  Step out(size);
  if (size < 6 || !has_axis(from, span_s)) {
    out.head(3) = eigen_of(turn_between(from.attitude, to.attitude));
    if (size >= 6)
      out.tail(3) = eigen_of((to.rate_rad_s - from.rate_rad_s) * span_s);
    return out;
  }
  const double rate = norm(from.rate_rad_s), other = norm(to.rate_rad_s);
  const Vec3<Body> axis = from.rate_rad_s * (1 / rate);
  const Vec3<Body> mounting =
      other > 0 ? tilt_between(axis, to.rate_rad_s * (1 / other)) : Vec3<Body>{0, 0, 0};
  out.head(3) = eigen_of(tilt_and_roll(from.attitude, turned(to.attitude, mounting), axis));
  out.tail(3) = eigen_of(mounting + axis * ((other - rate) * span_s));
  return out;
}

double log_volume(const Turning &from, const Step &step, double span_s) {
  constexpr double least = 1e-6;
  if (step.size() < 6 || !has_axis(from, span_s)) // of rotation vectors
    return 2 * std::log(std::max(sinc(step.head(3).norm() / 2), least));
  // Of polar coordinates about the axis, among the stars and in the body.
  const double rate = norm(from.rate_rad_s);
  const Vec3<Body> axis = from.rate_rad_s * (1 / rate);
  const auto [faster, mounting] = split(part(step, 3), axis);
  const double turns = std::abs(rate * span_s + faster);
  return std::log(std::max(sinc(norm(split(part(step, 0), axis).across)), least)) +
         std::log(std::max(sinc(norm(mounting)), least)) + 2 * std::log(std::max(turns, least));
}

std::vector<double> out_of_steps(const Eigen::MatrixXd &covariance, const Turning &about,
                                 double span_s) {
  const Eigen::MatrixXd out = carried(covariance, about, span_s, false);
  return {out.data(), out.data() + out.size()};
}

Eigen::MatrixXd in_steps(const std::vector<double> &covariance, const Turning &about,
                         double span_s) {
  const auto n = static_cast<Eigen::Index>(std::lround(std::sqrt(covariance.size())));
  return carried(Eigen::Map<const Eigen::MatrixXd>(covariance.data(), n, n), about, span_s, true);
}

} // namespace umov::inverse
