#pragma once
// Private: Gauss-Legendre quadrature. Boost.Math's `gauss` integrates one function; double sums
// over nodes and weights (masking, albedos, measured tables) want both halves of a rule in plain
// arrays.

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace umov {

template <std::size_t N> struct GaussRule {
  std::array<double, N> x{}, w{}; ///< on [-1, 1]
};

/// Nodes by Newton's iteration on the Legendre polynomial (Abramowitz & Stegun 25.4.29).
template <std::size_t N> GaussRule<N> make_gauss_rule() {
  GaussRule<N> rule;
  for (std::size_t i = 0; i < N; ++i) {
    double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (N + 0.5));
    double slope = 1;
    for (int step = 0; step < 100; ++step) {
      double p = 1, before = 0;
      for (std::size_t k = 0; k < N; ++k) {
        const double n = static_cast<double>(k);
        const double next = ((2 * n + 1) * x * p - n * before) / (n + 1);
        before = p;
        p = next;
      }
      slope = static_cast<double>(N) * (x * p - before) / (x * x - 1);
      const double shift = p / slope;
      x -= shift;
      if (std::abs(shift) < 1e-15)
        break;
    }
    rule.x[i] = x;
    rule.w[i] = 2 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

template <std::size_t N> const GaussRule<N> &gauss_rule() {
  static const GaussRule<N> rule = make_gauss_rule<N>();
  return rule;
}

/// Integral of f over [a, b] with N nodes.
template <std::size_t N = 64, class F> double gauss_integral(double a, double b, F f) {
  const auto &rule = gauss_rule<N>();
  double sum = 0;
  for (std::size_t i = 0; i < rule.x.size(); ++i)
    sum += rule.w[i] * f(0.5 * (a + b) + 0.5 * (b - a) * rule.x[i]);
  return 0.5 * (b - a) * sum;
}

} // namespace umov
