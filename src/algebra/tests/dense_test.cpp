// Expected values: by hand, of matrices small enough for it. Tolerance: rounding of a few
// operations.
#include "algebra/dense.h"

#include <cmath>
#include <gtest/gtest.h>

namespace umov::algebra {
namespace {

constexpr double rounding = 1e-14;

MatrixXd two_by_two(double a, double b, double c, double d) {
  MatrixXd out(2, 2);
  out << a, b, c, d;
  return out;
}

TEST(Dense, ProductsByHand) {
  MatrixXd a(3, 2);
  a << 1, 2, 3, 4, 5, 6;
  VectorXd v(2);
  v << 1, -1;
  EXPECT_EQ(gram(a), two_by_two(35, 44, 44, 56));
  EXPECT_EQ(transposed_product(a, a), gram(a));
  EXPECT_EQ(product(a, two_by_two(0, 1, 1, 0)).row(2), Eigen::RowVector2d(6, 5));
  EXPECT_EQ(times(a, v), VectorXd::Constant(3, -1));
  EXPECT_EQ(transposed_times(a, VectorXd::Ones(3)), VectorXd(Eigen::Vector2d(9, 12)));
}

TEST(Dense, LineThroughThreePoints) {
  // (0, 0), (1, 1), (2, 5): the line of least squares is 2.5 t - .5.
  MatrixXd a(3, 2);
  a << 1, 0, 1, 1, 1, 2;
  VectorXd y(3);
  y << 0, 1, 5;
  for (const VectorXd &x : {least_squares(a, y), least_squares_of_full_rank(a, y)}) {
    EXPECT_NEAR(x(0), -.5, rounding);
    EXPECT_NEAR(x(1), 2.5, rounding);
  }
}

TEST(Dense, SymmetricFactorByHand) {
  // [[4, 2], [2, 3]]: determinant 8, inverse [[3, -2], [-2, 4]] / 8.
  const SymmetricFactor factor(two_by_two(4, 2, 2, 3));
  ASSERT_TRUE(factor.is_solvable());
  EXPECT_NEAR(factor.log_determinant(), std::log(8.), rounding);
  const MatrixXd inverse = factor.inverse();
  EXPECT_NEAR((inverse - two_by_two(3, -2, -2, 4) / 8).cwiseAbs().maxCoeff(), 0, rounding);
  EXPECT_NEAR((factor.solve(Eigen::Vector2d(8, 0)) - Eigen::Vector2d(3, -2)).norm(), 0, rounding);
  EXPECT_NEAR((inverse_of(two_by_two(4, 2, 2, 3)) - inverse).norm(), 0, rounding);
  const MatrixXd root = cholesky_root(two_by_two(4, 2, 2, 3));
  EXPECT_NEAR((root - two_by_two(2, 0, 1, std::sqrt(2.))).norm(), 0, rounding);
}

TEST(Dense, EigenAndSingularValuesByHand) {
  // [[2, 1], [1, 2]]: 1 along (1, -1), 3 along (1, 1).
  const SymmetricEigen eigen = symmetric_eigen(two_by_two(2, 1, 1, 2));
  EXPECT_NEAR(eigen.values(0), 1, rounding);
  EXPECT_NEAR(eigen.values(1), 3, rounding);
  EXPECT_NEAR((symmetric_eigenvalues(two_by_two(2, 1, 1, 2)) - eigen.values).norm(), 0, rounding);
  EXPECT_NEAR(std::abs(eigen.vectors.col(1).sum()), std::sqrt(2.), rounding);
  EXPECT_NEAR(singular_values(two_by_two(0, -3, 2, 0))(0), 3, rounding);
  // Of rank one: [[1, 1], [1, 1]] has [[1, 1], [1, 1]] / 4.
  EXPECT_NEAR((pseudo_inverse(two_by_two(1, 1, 1, 1)) - two_by_two(1, 1, 1, 1) / 4).norm(), 0,
              rounding);
}

} // namespace
} // namespace umov::algebra
