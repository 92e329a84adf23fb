#pragma once
// The vocabulary of kernels: what a lane type R must offer beyond arithmetic. No branches on an R.

#include <algorithm>
#include <cmath>

namespace umov::kernel {

template <class R> inline R select(bool condition, R yes, R no) { return condition ? yes : no; }
template <class R> inline R clamped(R x, R low, R high) { return std::min(std::max(x, low), high); }
/// x^m for x in [0, 1], m >= 0, in log space: exact at 1, 0^0 = 1.
template <class R> inline R power(R x, R m) {
  const R tiny = R(1e-30);
  return std::exp(m * std::log(std::max(x, tiny)));
}

} // namespace umov::kernel
