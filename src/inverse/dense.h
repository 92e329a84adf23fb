#pragma once
// Private: what matrices of any size are asked here. Eigen's solvers are compiled once, in
// dense.cpp; elsewhere <Eigen/Core> will do.

#include <Eigen/Core>

namespace umov::inverse {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// a^T a.
MatrixXd gram(const MatrixXd &a);
/// a^T b.
VectorXd transposed_times(const MatrixXd &a, const VectorXd &b);
/// a b.
MatrixXd product(const MatrixXd &a, const MatrixXd &b);
/// x with the least |a x - b|.
VectorXd least_squares(const MatrixXd &a, const VectorXd &b);
/// x with m x = b, m symmetric.
VectorXd solve_symmetric(const MatrixXd &m, const VectorXd &b);
/// Moore and Penrose's inverse of a symmetric matrix.
MatrixXd pseudo_inverse(const MatrixXd &m);
/// Falling.
VectorXd singular_values(const MatrixXd &m);
MatrixXd inverse_of(const MatrixXd &m);
/// Lower triangular L with L L^T = m, m symmetric and positive.
MatrixXd cholesky_root(const MatrixXd &m);

struct SymmetricEigen {
  VectorXd values;  ///< rising
  MatrixXd vectors; ///< columns
};
SymmetricEigen symmetric_eigen(const MatrixXd &m);

} // namespace umov::inverse
