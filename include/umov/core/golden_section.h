#pragma once
// Where a function of one variable is least.

namespace umov {

/// The place of the least `f` between a < b, to `tolerance`, where f has one minimum there. One
/// call per step (golden section; Kiefer 1953). Not Boost.Math's brent_find_minima: its tolerance
/// is relative to the place, which here is a time since an arbitrary start.
template <typename F> double golden_minimum(F &&f, double a, double b, double tolerance) {
  constexpr double ratio = 0.61803398874989485;
  double c = b - ratio * (b - a), d = a + ratio * (b - a), f_c = f(c), f_d = f(d);
  while (b - a > tolerance) {
    if (f_c < f_d) {
      b = d;
      d = c;
      f_d = f_c;
      c = b - ratio * (b - a);
      f_c = f(c);
    } else {
      a = c;
      c = d;
      f_c = f_d;
      d = a + ratio * (b - a);
      f_d = f(d);
    }
  }
  return 0.5 * (a + b);
}

} // namespace umov
