#include "algebra/dense.h"
#include "algebra/whitener.h"

#include <gtest/gtest.h>

namespace umov::algebra {
namespace {

/// Against the solvers of Eigen: r^T C^-1 r, ln det C, and that whitened columns have C^-1 between
/// them.
TEST(Whitener, IsTheRootOfTheInverse) {
  const std::vector<double> variances{4, 9, 2, 7}, effects{1, .3, -2, .1, .5, 2, 0, -1};
  MatrixXd c = MatrixXd::Zero(4, 4);
  for (Eigen::Index a = 0; a < 4; ++a) {
    c(a, a) = variances[static_cast<std::size_t>(a)];
    for (Eigen::Index b = 0; b < 4; ++b)
      for (Eigen::Index t = 0; t < 2; ++t)
        c(a, b) += effects[static_cast<std::size_t>(2 * a + t)] *
                   effects[static_cast<std::size_t>(2 * b + t)];
  }
  Whitener whitener;
  whitener.reset(std::vector<double>(7, 1), std::vector<double>(14, .5),
                 2); // what it was used for before
  whitener.reset(variances, effects, 2);
  const SymmetricFactor factor(c);
  EXPECT_NEAR(whitener.log_determinant(), factor.log_determinant(), 1e-13);
  std::vector<double> x{1, -2, 3, .5}, y{.2, 0, -1, 4};
  const VectorXd of_x = Eigen::Map<VectorXd>(x.data(), 4), of_y = Eigen::Map<VectorXd>(y.data(), 4);
  whitener.whiten(x);
  whitener.whiten(y);
  double dot = 0;
  for (std::size_t k = 0; k < 4; ++k)
    dot += x[k] * y[k];
  EXPECT_NEAR(dot, of_x.dot(factor.solve(of_y)), 1e-13);
}

} // namespace
} // namespace umov::algebra
