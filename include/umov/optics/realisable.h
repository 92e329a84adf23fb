#pragma once
#include <array>
#include <umov/optics/stokes.h>

namespace umov {

/// Eigenvalues of the coherency matrix of a Mueller matrix, increasing (Cloude 1986). All are >= 0,
/// within rounding, exactly for matrices that are sums of deterministic (Jones) ones: those that
/// can happen. Their sum is M00.
std::array<double, 4> cloude_eigenvalues(const std::array<std::array<double, 4>, 4> &mueller);

} // namespace umov
