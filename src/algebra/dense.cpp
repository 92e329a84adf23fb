#include "algebra/dense.h"

#include <Eigen/Dense>

namespace umov::algebra {

MatrixXd gram(const MatrixXd &a) { // half of it, which is half the work
  MatrixXd out = MatrixXd::Zero(a.cols(), a.cols());
  out.selfadjointView<Eigen::Lower>().rankUpdate(a.transpose());
  out.triangularView<Eigen::StrictlyUpper>() = out.transpose();
  return out;
}
MatrixXd product(const MatrixXd &a, const MatrixXd &b) { return a * b; }
VectorXd times(const MatrixView &a, const VectorXd &b) { return a * b; }
MatrixXd transposed_product(const MatrixXd &a, const MatrixXd &b) { return a.transpose() * b; }
VectorXd transposed_times(const MatrixView &a, const VectorXd &b) { return a.transpose() * b; }

VectorXd least_squares(const MatrixXd &a, const VectorXd &b) {
  return a.colPivHouseholderQr().solve(b);
}
VectorXd least_squares_of_full_rank(const MatrixXd &a, const VectorXd &b) {
  return a.householderQr().solve(b);
}
VectorXd solve_symmetric(const MatrixXd &m, const VectorXd &b) {
  return SymmetricFactor(m).solve(b);
}

MatrixXd pseudo_inverse(const MatrixXd &m) {
  return m.completeOrthogonalDecomposition().pseudoInverse();
}
VectorXd singular_values(const MatrixXd &m) { return m.jacobiSvd().singularValues(); }
MatrixXd inverse_of(const MatrixXd &m) { return m.inverse(); }
MatrixXd cholesky_root(const MatrixXd &m) { return m.llt().matrixL(); }

SymmetricEigen symmetric_eigen(const MatrixXd &m) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(m);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd symmetric_eigenvalues(const MatrixXd &m) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(m, Eigen::EigenvaluesOnly).eigenvalues();
}

struct SymmetricFactor::Parts {
  Eigen::LDLT<MatrixXd> ldlt;
};

SymmetricFactor::SymmetricFactor(const MatrixXd &m)
    : parts_(std::make_shared<const Parts>(Parts{Eigen::LDLT<MatrixXd>(m)})) {}

bool SymmetricFactor::is_solvable() const { return parts_->ldlt.info() == Eigen::Success; }
VectorXd SymmetricFactor::solve(const VectorXd &b) const { return parts_->ldlt.solve(b); }
MatrixXd SymmetricFactor::solve_columns(const MatrixXd &b) const { return parts_->ldlt.solve(b); }
MatrixXd SymmetricFactor::inverse() const {
  return solve_columns(MatrixXd::Identity(parts_->ldlt.rows(), parts_->ldlt.cols()));
}
double SymmetricFactor::log_determinant() const {
  return parts_->ldlt.vectorD().array().log().sum();
}

} // namespace umov::algebra
