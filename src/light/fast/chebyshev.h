#pragma once
// Private: polynomials through functions that are known at Chebyshev's nodes.

#include "kernel/facet_constants.h"

#include <array>
#include <cstddef>

namespace umov {

using Coefficients = std::array<double, kernel::polynomial_degree + 1>;
inline constexpr std::size_t chebyshev_nodes = 64;
using NodeValues = std::array<double, chebyshev_nodes>;

/// Node number i, in [-1, 1].
double chebyshev_node(std::size_t i);
/// Least squares over the nodes, as powers of t.
Coefficients fit_polynomial(const NodeValues &value, std::size_t degree);

} // namespace umov
