#include "light/fast/chebyshev.h"

#include "kernel/math.inl.h"

#include "algebra/dense.h"
#include <cmath>
#include <numbers>
#include <vector>

namespace umov {
namespace {

constexpr std::size_t nodes = chebyshev_nodes;

/// Powers of t of Chebyshev's polynomials T_0 ... T_degree.
std::vector<Coefficients> chebyshev_powers(std::size_t degree) {
  std::vector<Coefficients> out{{1}, {0, 1}};
  for (std::size_t k = 2; k <= degree; ++k) { // T_k = 2 t T_{k-1} - T_{k-2}
    Coefficients next{};
    for (std::size_t j = 0; j < kernel::polynomial_degree; ++j)
      next[j + 1] = 2 * out[k - 1][j];
    for (std::size_t j = 0; j <= kernel::polynomial_degree; ++j)
      next[j] -= out[k - 2][j];
    out.push_back(next);
  }
  return out;
}

} // namespace

double chebyshev_node(std::size_t i) {
  return std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / nodes);
}

Coefficients fit_polynomial(const NodeValues &value, std::size_t degree) {
  const auto powers = chebyshev_powers(degree);
  const auto columns = static_cast<Eigen::Index>(degree + 1);
  Eigen::MatrixXd a(static_cast<Eigen::Index>(nodes), columns);
  Eigen::VectorXd b(static_cast<Eigen::Index>(nodes));
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    b(row) = value[i];
    for (Eigen::Index k = 0; k < columns; ++k)
      a(row, k) = kernel::polynomial(powers[static_cast<std::size_t>(k)].data(),
                                     static_cast<std::size_t>(k), chebyshev_node(i));
  }
  const Eigen::VectorXd c = algebra::least_squares_of_full_rank(a, b);
  Coefficients out{};
  for (std::size_t k = 0; k <= degree; ++k)
    for (std::size_t j = 0; j <= k; ++j)
      out[j] += c(static_cast<Eigen::Index>(k)) * powers[k][j];
  return out;
}

} // namespace umov
