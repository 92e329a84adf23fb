// The vocabulary of kernels: what a lane type R must offer beyond arithmetic. No branches on an R.
// A lane type brings its own of these functions, found by its arguments.
#if defined(UMOV_KERNEL_MATH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_MATH_INL_H
#undef UMOV_KERNEL_MATH_INL_H
#else
#define UMOV_KERNEL_MATH_INL_H
#endif

#include <cmath>
#include <cstddef>

#include "kernel/begin.h"

using std::abs;
using std::acos;
using std::atan;
using std::erfc;
using std::exp;
using std::exp2;
using std::log;
using std::log1p;
using std::sqrt;

template <class R> UMOV_KERNEL R select(bool condition, R yes, R no) {
  return condition ? yes : no;
}
UMOV_KERNEL bool any(bool condition) { return condition; }
// As the standard library's, which device code cannot call: the first one stays where neither is
// less.
template <class R> UMOV_KERNEL R min(R a, R b) { return select(b < a, b, a); }
template <class R> UMOV_KERNEL R max(R a, R b) { return select(a < b, b, a); }
template <class R> UMOV_KERNEL R clamped(R x, R low, R high) { return min(max(x, low), high); }
template <class R> UMOV_KERNEL R inverse_sqrt(R x) { return R(1) / sqrt(x); }
/// x^m for x in [0, 1], m >= 0, in log space: exact at 1, 0^0 = 1.
template <class R> UMOV_KERNEL R power(R x, R m) {
  const R tiny = R(1e-30);
  return exp(m * log(max(x, tiny)));
}
/// log2(1 - y) for y in [0, 1]; at y = 1 that of the last number before 1: -53, in float -24.
template <class R> UMOV_KERNEL R log2_of_one_minus(R y) {
  return log1p(-min(y, R(1 - 1e-16))) * R(1.4426950408889634);
}
UMOV_KERNEL float log2_of_one_minus(float y) {
  return log1p(-min(y, 1 - 6e-8F)) * 1.4426950408889634F;
}

/// a b + c, which lanes round once where the machine does.
template <class R> UMOV_KERNEL R product_and(R a, R b, R c) { return a * b + c; }

/// Polynomial c[0] + c[1] t + ... of degree n.
template <class R, class T> UMOV_KERNEL R polynomial(const T *c, std::size_t n, R t) {
  R sum = R(c[n]);
  for (std::size_t k = n; k-- > 0;)
    sum = sum * t + R(c[k]);
  return sum;
}

#include "kernel/end.h"
#endif
