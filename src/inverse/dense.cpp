#include "inverse/dense.h"

#include <Eigen/Dense>

namespace umov::inverse {

MatrixXd gram(const MatrixXd &a) { return a.transpose() * a; }
VectorXd transposed_times(const MatrixXd &a, const VectorXd &b) { return a.transpose() * b; }
MatrixXd product(const MatrixXd &a, const MatrixXd &b) { return a * b; }

VectorXd least_squares(const MatrixXd &a, const VectorXd &b) {
  return a.colPivHouseholderQr().solve(b);
}
VectorXd solve_symmetric(const MatrixXd &m, const VectorXd &b) { return m.ldlt().solve(b); }

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

} // namespace umov::inverse
