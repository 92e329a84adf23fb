#pragma once
// Private to the library: what real matrices of any size are asked. Eigen's products and solvers
// take seconds to compile wherever they are named, so they are named once, in dense.cpp; elsewhere
// <Eigen/Core> will do.

#include <Eigen/Core>
#include <memory>

namespace umov::algebra {

using Eigen::MatrixXd;
using Eigen::VectorXd;
/// A matrix or a block of one, without a copy.
using MatrixView = Eigen::Ref<const MatrixXd>;

/// a^T a.
MatrixXd gram(const MatrixXd &a);
/// a b.
MatrixXd product(const MatrixXd &a, const MatrixXd &b);
VectorXd times(const MatrixView &a, const VectorXd &b);
/// a^T b.
MatrixXd transposed_product(const MatrixXd &a, const MatrixXd &b);
VectorXd transposed_times(const MatrixView &a, const VectorXd &b);
/// x with the least |a x - b|.
VectorXd least_squares(const MatrixXd &a, const VectorXd &b);
/// The same where the columns of a are known to be independent: no pivots.
VectorXd least_squares_of_full_rank(const MatrixXd &a, const VectorXd &b);
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
/// Rising, where nobody asks for the vectors: a tenth of the work.
VectorXd symmetric_eigenvalues(const MatrixXd &m);

/// A symmetric matrix taken apart once (L D L^T), for several right sides.
class SymmetricFactor {
public:
  explicit SymmetricFactor(const MatrixXd &m);
  [[nodiscard]] bool is_solvable() const;
  [[nodiscard]] VectorXd solve(const VectorXd &b) const;
  [[nodiscard]] MatrixXd solve_columns(const MatrixXd &b) const;
  [[nodiscard]] MatrixXd inverse() const;
  /// Of a positive matrix.
  [[nodiscard]] double log_determinant() const;

private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

} // namespace umov::algebra
