#include <umov/optics/realisable.h>

#include <Eigen/Eigenvalues>
#include <complex>

namespace umov {

std::array<double, 4> cloude_eigenvalues(const std::array<std::array<double, 4>, 4> &mueller) {
  using Complex = std::complex<double>;
  const Complex i(0, 1);
  // Pauli matrices in the order of Stokes I, Q, U, V.
  const std::array<Eigen::Matrix2cd, 4> sigma{Eigen::Matrix2cd::Identity(),
                                              (Eigen::Matrix2cd() << 1, 0, 0, -1).finished(),
                                              (Eigen::Matrix2cd() << 0, 1, 1, 0).finished(),
                                              (Eigen::Matrix2cd() << 0, -i, i, 0).finished()};
  Eigen::Matrix4cd coherency = Eigen::Matrix4cd::Zero();
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c)
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b)
          coherency.block<2, 2>(2 * a, 2 * b) +=
              0.25 * mueller[r][c] * sigma[r](a, b) * sigma[c].conjugate();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4cd> solver(coherency, Eigen::EigenvaluesOnly);
  const Eigen::Vector4d values = solver.eigenvalues();
  return {values(0), values(1), values(2), values(3)};
}

} // namespace umov
