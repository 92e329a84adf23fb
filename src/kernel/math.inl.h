// The vocabulary of kernels: what a lane type R must offer beyond arithmetic. No branches on an R.
// A lane type brings its own of these functions, found by its arguments.
#if defined(UMOV_KERNEL_MATH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_MATH_INL_H
#undef UMOV_KERNEL_MATH_INL_H
#else
#define UMOV_KERNEL_MATH_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernel/begin.h"

using std::abs;
using std::acos;
using std::erfc;
using std::exp;
using std::exp2;
using std::log;
using std::max;
using std::min;
using std::sqrt;

inline double inverse_sqrt(double x) { return 1 / std::sqrt(x); }
template <class R> inline R select(bool condition, R yes, R no) { return condition ? yes : no; }
inline bool any(bool condition) { return condition; }
template <class R> inline R clamped(R x, R low, R high) { return min(max(x, low), high); }
/// x^m for x in [0, 1], m >= 0, in log space: exact at 1, 0^0 = 1.
template <class R> inline R power(R x, R m) {
  const R tiny = R(1e-30);
  return exp(m * log(max(x, tiny)));
}
/// log2(1 - y) for y in [0, 1]; y = 1 gives about -100.
inline double log2_of_one_minus(double y) {
  return std::log1p(-std::min(y, 1 - 1e-16)) * 1.4426950408889634;
}

/// Polynomial c[0] + c[1] t + ... of degree n.
template <class R, class T> inline R polynomial(const T *c, std::size_t n, R t) {
  R sum = R(c[n]);
  for (std::size_t k = n; k-- > 0;)
    sum = sum * t + R(c[k]);
  return sum;
}

#include "kernel/end.h"
#endif
