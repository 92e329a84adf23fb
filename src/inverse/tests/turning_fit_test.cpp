#include "inverse/turning_fit.h"

#include <Eigen/Geometry>
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

TEST(TurningFit, AStepLeadsThereAndBack) {
  for (const Turning &from : {still, quick})
    for (const Step &step : {six(.1, -.2, .05, .3, .02, -.1), six(0, 0, 0, 1e-9, 0, 0),
                             six(.01, .02, .03, 0, 0, 0), six(0, 0, 0, -.5, 1.1, .4)}) {
      const Step back =
          inverse::step_between(from, inverse::stepped(from, step, span), 6, span);
      // Angles of quaternions and of vectors by arctangents: some 1e-9 of rounding, and the rate
      // of 800 turns keeps 1e-16 of them, 1e-12 rad.
      EXPECT_LT((back - step).norm(), 1e-8);
    }
}

/// A tilt of the axis shows by twice itself at most, after any number of turns: two turns by one
/// angle about axes that are d apart differ by a turn of at most 2 d.
TEST(TurningFit, ATiltLeavesTheNumberOfTurns) {
  const Vec3<Body> axis = normalized(quick.rate_rad_s);
  const Vec3<Body> across = normalized(cross(axis, Vec3<Body>{0, 0, 1}));
  constexpr double tilt = 0.01;
  const Turning tilted = inverse::stepped(
      quick, six(0, 0, 0, tilt * across.x, tilt * across.y, tilt * across.z), span);
  EXPECT_NEAR(norm(tilted.rate_rad_s), norm(quick.rate_rad_s), 1e-15);
  double farthest = 0;
  for (double t = 0; t < span; t += 97)
    farthest = std::max(farthest, angle_between(attitude_at(quick, t), attitude_at(tilted, t)));
  EXPECT_LT(farthest, 2 * tilt * 1.001);
  EXPECT_GT(farthest, 1.9 * tilt); // the bound is met half a turn on
}

/// The same by differences: determinant of the derivatives of the rate with the step.
TEST(TurningFit, VolumesOfRatesAreThoseOfTheirDerivatives) {
  for (const Turning &from : {still, quick})
    for (const Step &step : {six(0, 0, 0, 0, 0, 0), six(0, 0, 0, .4, -.7, .2)}) {
      const Turning to = inverse::stepped(from, step, span);
      Eigen::Matrix3d by;
      const double h = 1e-6;
      for (int k = 0; k < 3; ++k) {
        const Step unit = Step::Unit(6, 3 + k) * h;
        const Vec3<Body> change = inverse::stepped(from, step + unit, span).rate_rad_s -
                                  inverse::stepped(from, step - unit, span).rate_rad_s;
        by.col(k) << change.x / (2 * h), change.y / (2 * h), change.z / (2 * h);
      }
      const double volume = std::abs(by.col(0).dot(by.col(1).cross(by.col(2))));
      // Second differences: h^2 and rounding over h.
      EXPECT_NEAR(inverse::log_rate_volume(from, to, span), std::log(volume), 1e-4);
      if (step.norm() > 0)
        continue;
      const Eigen::Matrix3d told = inverse::rate_by_step(from, span);
      EXPECT_LT((told - by).norm(), 1e-6 * by.norm());
      EXPECT_LT((told * inverse::step_by_rate(from, span) - Eigen::Matrix3d::Identity()).norm(),
                1e-9);
    }
}

} // namespace
} // namespace umov
