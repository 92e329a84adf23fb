#include <umov/optics/realisable.h>

#include "algebra/dense.h"
#include <complex>

namespace umov {

std::array<double, 4> cloude_eigenvalues(const std::array<std::array<double, 4>, 4> &mueller) {
  using Complex = std::complex<double>;
  const Complex i(0, 1);
  // Pauli matrices in the order of Stokes I, Q, U, V.
  const Complex sigma[4][2][2]{
      {{1, 0}, {0, 1}}, {{1, 0}, {0, -1}}, {{0, 1}, {1, 0}}, {{0, -i}, {i, 0}}};
  Complex coherency[4][4]{};
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
          coherency[row][column] += 0.25 * mueller[r][c] * sigma[r][row / 2][column / 2] *
                                    std::conj(sigma[c][row % 2][column % 2]);
  // The real and symmetric [[Re, -Im], [Im, Re]] has the eigenvalues of the Hermitian one, each
  // twice.
  algebra::MatrixXd real(8, 8);
  for (Eigen::Index row = 0; row < 8; ++row)
    for (Eigen::Index column = 0; column < 8; ++column) {
      const Complex &z = coherency[row % 4][column % 4];
      real(row, column) = row / 4 == column / 4 ? z.real() : row < 4 ? -z.imag() : z.imag();
    }
  const algebra::VectorXd values = algebra::symmetric_eigenvalues(real);
  return {values(0), values(2), values(4), values(6)};
}

} // namespace umov
