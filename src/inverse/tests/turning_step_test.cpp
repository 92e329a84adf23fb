#include "inverse/turning_step.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <umov/inverse/attitude_grid.h>

namespace umov {
namespace {

using inverse::Step;

Step six(double a, double b, double c, double d, double e, double f) {
  Step out(6);
  out << a, b, c, d, e, f;
  return out;
}

const Turning still{attitude_grid(100)[41], {1e-7, -2e-7, 1e-7}};
const Turning quick{attitude_grid(100)[17], {0.05, -0.11, 0.03}};
constexpr double span = 40'000; // s: 800 turns of the quick one, 10 mrad of the still one

Step of(const Vec3<Body> &first, const Vec3<Body> &last) {
  return six(first.x, first.y, first.z, last.x, last.y, last.z);
}

const Vec3<Body> none{0, 0, 0};

Vec3<Body> axis() { return normalized(quick.rate_rad_s); }

TEST(TurningStep, LeadsThereAndBack) {
  for (const Turning &from : {still, quick})
    for (const Step &step : {six(.1, -.2, .05, .3, .02, -.1), six(0, 0, 0, 1e-9, 0, 0),
                             six(.01, .02, .03, 0, 0, 0), six(2, -1.5, .5, -.5, 1.1, .4)}) {
      const Step back = inverse::step_between(from, inverse::stepped(from, step, span), 6, span);
      // Rounding of angles near 1 from quaternions and of 5,000 radians of turns: 1e-12.
      EXPECT_LT((back - step).norm(), 1e-10);
    }
}

/// Spins of one attitude about opposite axes are half a turn of the body apart, not one spin.
TEST(TurningStep, OppositeSpinsAreApart) {
  const Turning other{quick.attitude, quick.rate_rad_s * -1};
  const Step step = inverse::step_between(quick, other, 6, span);
  EXPECT_NEAR(step.tail(3).norm(), pi, 1e-9);
  const Turning there = inverse::stepped(quick, step, span);
  EXPECT_LT(norm(there.rate_rad_s - other.rate_rad_s), 1e-12);
  EXPECT_LT(angle_between(there.attitude, other.attitude), 1e-9);
}

/// Two turns by one angle about axes that are d apart differ by a turn of at most 2 d.
TEST(TurningStep, TiltsLeaveTheNumberOfTurns) {
  constexpr double tilt = 0.01;
  const Vec3<Body> across = normalized(cross(axis(), Vec3<Body>{0, 0, 1})) * tilt;
  for (const Step &step : {of(across, none), of(none, across)}) {
    const Turning moved = inverse::stepped(quick, step, span);
    EXPECT_NEAR(norm(moved.rate_rad_s), norm(quick.rate_rad_s), 1e-15);
    double farthest = 0;
    for (double t = 0; t < span; t += 97)
      farthest = std::max(farthest, angle_between(attitude_at(quick, t), attitude_at(moved, t)));
    // Tilted as a whole, the body is off by the tilt at all times.
    EXPECT_NEAR(farthest, tilt, 1e-9);
  }
}

/// The spin's axis among the stars is that of the first tilt alone, the axis in the body that of
/// the second alone.
TEST(TurningStep, AxesAmongTheStarsAndInTheBodyAreApart) {
  const auto among_stars = [](const Turning &t) {
    return rotation_from<Body, Gcrs>(t.attitude).inverse() * normalized(t.rate_rad_s);
  };
  const Vec3<Body> across = normalized(cross(axis(), Vec3<Body>{0, 0, 1})) * 0.3;
  const Turning mounted = inverse::stepped(quick, of(axis() * 0.7, across + axis() * 0.2), span);
  EXPECT_LT(angle_between(among_stars(mounted), among_stars(quick)), 1e-12);
  EXPECT_NEAR(angle_between(normalized(mounted.rate_rad_s), axis()), 0.3, 1e-12);
  const Turning tilted = inverse::stepped(quick, of(across + axis() * 0.7, axis() * 0.2), span);
  EXPECT_NEAR(angle_between(among_stars(tilted), among_stars(quick)), 0.3, 1e-12);
  EXPECT_LT(angle_between(normalized(tilted.rate_rad_s), axis()), 1e-12);
  // A radian more over the span.
  EXPECT_NEAR((norm(tilted.rate_rad_s) - norm(quick.rate_rad_s)) * span, 0.2, 1e-9);
}

/// Directions in the body, by the attitude at each time.
TEST(Turning, PosesAreThoseOfTheAttitudeAtTheirTime) {
  const Turning fixed{quick.attitude, {}};
  for (const Turning &turning : {fixed, still, quick})
    for (const double seconds : {-7.5, 0.0, 3.0, 911.0}) {
      ObservedEpoch epoch;
      epoch.seconds = seconds;
      epoch.to_sun = normalized(Vec3<Gcrs>{.3, -.8, .2});
      epoch.to_observer = normalized(Vec3<Gcrs>{-.1, .4, .9});
      epoch.sun_radius_rad = 5e-3;
      const auto body = rotation_from<Body, Gcrs>(attitude_at(turning, seconds));
      const Pose pose = pose_at(turning, epoch);
      // Rounding of a hundred radians.
      EXPECT_LT(norm(pose.sun - body * epoch.to_sun), 1e-12);
      EXPECT_LT(norm(pose.observer - body * epoch.to_observer), 1e-12);
      EXPECT_EQ(pose.sun_radius_rad, 5e-3);
    }
}

/// Derivatives of rotation vector and rate where a step has led to, by differences.
Eigen::MatrixXd derivatives(const Turning &from, const Step &step) {
  const Turning at = inverse::stepped(from, step, span);
  Eigen::MatrixXd out(6, 6);
  const double h = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const Step unit = Step::Unit(6, k) * h;
    const Turning more = inverse::stepped(from, step + unit, span);
    const Turning less = inverse::stepped(from, step - unit, span);
    const Vec3<Body> turn =
        (turn_between(at.attitude, more.attitude) - turn_between(at.attitude, less.attitude)) *
        (1 / (2 * h));
    const Vec3<Body> rate = (more.rate_rad_s - less.rate_rad_s) * (1 / (2 * h));
    out.col(k) << turn.x, turn.y, turn.z, rate.x, rate.y, rate.z;
  }
  return out;
}

TEST(TurningStep, VolumesAndCovariancesAreThoseOfItsDerivatives) {
  for (const Turning &from : {still, quick}) {
    for (const Step &step : {six(0, 0, 0, 0, 0, 0), six(.8, -.3, .5, .4, -.7, .2)}) {
      Eigen::MatrixXd by = derivatives(from, step);
      by.bottomRows(3) *= span;
      // Differences: h^2 and rounding over h, 1e-9.
      EXPECT_NEAR(inverse::log_volume(from, step, span), std::log(std::abs(by.determinant())),
                  1e-6);
    }
    const Eigen::MatrixXd by = derivatives(from, Step::Zero(6));
    Eigen::VectorXd sd(6);
    sd << .1, .2, .3, .04, .05, .06;
    const Eigen::MatrixXd root =
        sd.asDiagonal() * (Eigen::MatrixXd::Ones(6, 6) * .3 + Eigen::MatrixXd::Identity(6, 6));
    const Eigen::MatrixXd covariance = root * root.transpose();
    const Eigen::MatrixXd expected = by * covariance * by.transpose();
    const auto told = inverse::out_of_steps(covariance, from, span);
    const Eigen::Map<const Eigen::MatrixXd> found(told.data(), 6, 6);
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c)
        EXPECT_NEAR(found(r, c), expected(r, c), 1e-6 * std::sqrt(expected(r, r) * expected(c, c)));
    const Eigen::MatrixXd back = inverse::in_steps(told, from, span);
    EXPECT_LT((back - covariance).norm(), 1e-9 * covariance.norm());
  }
}

} // namespace
} // namespace umov
