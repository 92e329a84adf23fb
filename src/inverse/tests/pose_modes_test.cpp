#include "inverse/pose_modes.h"

#include <gtest/gtest.h>
#include <umov/inverse/attitude_grid.h>

namespace umov {
namespace {

using inverse::degree;
using inverse::Step;
using inverse::TurningFit;

const Turning centre{attitude_grid(100)[17], {0.05, -0.11, 0.03}};
constexpr double span = 400; // s: eight turns

/// A fit some way off the centre, as good as any, with these standard deviations about axes that
/// are those of no unknown.
TurningFit fit_at(const Step &step, const Eigen::VectorXd &sd, const Eigen::MatrixXd &directions) {
  TurningFit out;
  out.turning = inverse::stepped(centre, step, span);
  out.information =
      directions * sd.cwiseAbs2().cwiseInverse().asDiagonal() * directions.transpose();
  out.is_converged = true;
  return out;
}

/// An orthogonal matrix without zeros (a reflection, Householder's).
Eigen::MatrixXd oblique(Eigen::Index size) {
  const Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(size, 1, 2).normalized();
  return Eigen::MatrixXd::Identity(size, size) - 2 * v * v.transpose();
}

std::size_t modes_apart(Eigen::Index direction, double by, const Eigen::VectorXd &sd) {
  const Eigen::MatrixXd directions = oblique(sd.size());
  const std::vector<TurningFit> fits{fit_at(Step::Zero(sd.size()), sd, directions),
                                     fit_at(directions.col(direction) * by, sd, directions)};
  return inverse::modes_of(fits, span).size();
}

TEST(PoseModes, SpinsBesideAValleyAreOthersThanThoseInIt) {
  Eigen::VectorXd sd(6);
  sd << 2e-4, 3e-4, 1e-4, 5e-2, 2e-4, 1e-4;
  const Eigen::Index valley = 3;
  EXPECT_EQ(modes_apart(valley, 11 * degree, sd), 1u);
  EXPECT_EQ(modes_apart(valley, 14 * degree, sd), 2u);
  for (const Eigen::Index across : {0, 1, 2, 4, 5}) {
    EXPECT_EQ(modes_apart(across, 0.9 * degree, sd), 1u) << across;
    EXPECT_EQ(modes_apart(across, 1.1 * degree, sd), 2u) << across;
    EXPECT_EQ(modes_apart(across, 5 * degree, sd), 2u) << across;
  }
}

TEST(PoseModes, WhatIsWithinThreeStandardDeviationsIsOnePeak) {
  Eigen::VectorXd sd(6);
  sd << 2e-2, 3e-4, 1e-4, 0.1, 2e-4, 1e-4;
  EXPECT_EQ(modes_apart(0, 0.058, sd), 1u);
  EXPECT_EQ(modes_apart(0, 0.062, sd), 2u);
  EXPECT_EQ(modes_apart(3, 0.29, sd), 1u);
  EXPECT_EQ(modes_apart(3, 0.31, sd), 2u);
}

TEST(PoseModes, AttitudesAreOnePeakWhicheverWayTheyAreApart) {
  Eigen::VectorXd sd(3);
  sd << 1e-4, 2e-2, 1e-4;
  for (const Eigen::Index direction : {0, 1, 2}) {
    EXPECT_EQ(modes_apart(direction, 0.058, sd), 1u) << direction;
    EXPECT_EQ(modes_apart(direction, 0.062, sd), 2u) << direction;
  }
}

TEST(PoseModes, WeightsAreThoseOfLaplacesIntegral) {
  Eigen::VectorXd narrow = Eigen::VectorXd::Constant(3, 1e-3), wide = 2 * narrow;
  const Eigen::MatrixXd directions = oblique(3);
  std::vector<TurningFit> fits{fit_at(Step::Zero(3), narrow, directions),
                               fit_at(directions.col(0), wide, directions),
                               fit_at(-directions.col(0), narrow, directions)};
  fits[1].at.minus_2_log = 2 * std::log(8.0); // eight times the volume at an eighth of the height
  fits[2].at.minus_2_log = 31;                // e^-15.5
  const auto modes = inverse::modes_of(fits, span);
  ASSERT_EQ(modes.size(), 2u);
  EXPECT_NEAR(modes[0].weight, 0.5, 1e-12);
  EXPECT_NEAR(modes[1].weight, 0.5, 1e-12);
}

} // namespace
} // namespace umov
