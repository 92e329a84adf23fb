#include "inverse/neighbours.h"

#include <cmath>
#include <gtest/gtest.h>

namespace umov {
namespace {

using inverse::Neighbours;

/// Residuals of a valley about x = curve * y^2, of the width of a glint, in which y is known a
/// hundred times worse.
struct Valley {
  double narrow = 3e-5, wide = 8e-3, curve = 2; // [rad], and its bend
  double angle = 0.4;                           ///< of x to the first unknown
  [[nodiscard]] std::vector<double> residuals(const inverse::Step &at) const {
    const double x = std::cos(angle) * at[0] + std::sin(angle) * at[1];
    const double y = std::cos(angle) * at[1] - std::sin(angle) * at[0];
    return {(x - curve * y * y) / narrow, y / wide, at[2] / wide};
  }
  /// What they grow by along its floor, at the origin: by hand.
  [[nodiscard]] Eigen::Vector3d along() const { return {0, 1 / wide, 0}; }
};

Eigen::MatrixXd jacobian_of(const Neighbours &where, const Valley &valley) {
  std::vector<std::vector<double>> near;
  for (std::size_t k = 0; k < where.count(); ++k)
    near.push_back(valley.residuals(where.step(k)));
  std::vector<const std::vector<double> *> pointers;
  for (const auto &one : near)
    pointers.push_back(&one);
  return where.jacobian(valley.residuals(inverse::Step::Zero(3)), pointers);
}

TEST(Neighbours, HalfAWidthAwayTheFloorOfAValleyIsSeen) {
  const Valley valley;
  const Eigen::Vector3d floor(-std::sin(valley.angle), std::cos(valley.angle), 0);
  // A milliradian away the walls, of 1/3e-5 a radian, are off by curve * 1e-3 of that: 67 a radian
  // in the mean of both unknowns, beside the 125 of the floor.
  const Eigen::MatrixXd rough = jacobian_of(Neighbours::alike(3, 1e-3), valley);
  EXPECT_GT((rough * floor - valley.along()).norm(), 0.15 * valley.along().norm());
  const Neighbours fine = Neighbours::half_widths(rough.transpose() * rough, 1e-3);
  EXPECT_EQ(fine.count(), 6);
  const Eigen::MatrixXd near = jacobian_of(fine, valley);
  // What is quadratic cancels out; axes that were found by the rough ones leave a mixed term.
  EXPECT_LT((near * floor - valley.along()).norm(), 0.01 * valley.along().norm());
}

/// How far neighbours are along each unknown.
Eigen::VectorXd extents(const Neighbours &where) {
  Eigen::VectorXd out = where.step(0).cwiseAbs();
  for (std::size_t k = 1; k < where.count(); ++k)
    out = out.cwiseMax(where.step(k).cwiseAbs());
  return out;
}

TEST(Neighbours, AreHalfAWidthAwayAndNoFartherThanTold) {
  const double narrow = 1e-4, wide = 0.1, longest = 2e-3;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(3, 3);
  information.diagonal() << 1 / (wide * wide), 1 / (narrow * narrow), 0; // the last tells nothing
  const Neighbours where = Neighbours::half_widths(information, longest);
  ASSERT_EQ(where.count(), 6);
  for (std::size_t k = 0; k < where.count(); ++k)
    EXPECT_LT((where.step(k) + where.step(k ^ 1)).norm(), 1e-15); // both sides
  const Eigen::VectorXd along = extents(where);
  EXPECT_NEAR(along[0], longest, 1e-12);
  EXPECT_NEAR(along[1], narrow / 2, 1e-12);
  EXPECT_NEAR(along[2], longest, 1e-12);
}

TEST(Neighbours, OfWhatIsToldTooWellOrNotAtAllAreAtTheEndsOfTheirRange) {
  constexpr double longest = 1e-3, shortest = 1e-6; // neighbours.cpp
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(6, 6);
  information.diagonal() << 1e14, -1e-9, 0, 1e14, 4e8, 1; // rounding makes such as the second
  const Neighbours where = Neighbours::half_widths(information, longest);
  ASSERT_EQ(where.count(), 12);
  const Eigen::VectorXd along = extents(where);
  const double expected[] = {shortest, longest, longest, shortest, 0.5 / 2e4, longest};
  for (int p = 0; p < 6; ++p)
    EXPECT_NEAR(along[p], expected[p], 1e-12) << p;
}

} // namespace
} // namespace umov
