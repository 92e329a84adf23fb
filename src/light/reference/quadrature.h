#pragma once
// Private: symmetric rules on a triangle, barycentric points.

#include <array>

namespace umov {

/// Seven points, weights for degree 5 (Radon 1948; Stroud 1971, T2:5-1) and, on the centroid and
/// the outer three of the same points, for degree 2; weights sum to 1.
struct TriangleRule {
  static constexpr std::size_t size = 7;
  static constexpr double root15 = 3.872983346207417; // sqrt(15)
  static constexpr double outer = (6 - root15) / 21, inner = (6 + root15) / 21;
  static constexpr std::array<std::array<double, 3>, size> point{{
      {1.0 / 3, 1.0 / 3, 1.0 / 3},
      {1 - 2 * outer, outer, outer},
      {outer, 1 - 2 * outer, outer},
      {outer, outer, 1 - 2 * outer},
      {1 - 2 * inner, inner, inner},
      {inner, 1 - 2 * inner, inner},
      {inner, inner, 1 - 2 * inner},
  }};
  static constexpr double weight_outer = (155 - root15) / 1200;
  static constexpr double weight_inner = (155 + root15) / 1200;
  static constexpr std::array<double, size> weight{
      9.0 / 40, weight_outer, weight_outer, weight_outer, weight_inner, weight_inner, weight_inner};
  // Degree 2 asks for sum w = 1 and sum w b^2 = 1/6 over one barycentric coordinate b.
  static constexpr double outer_squares = (1 - 2 * outer) * (1 - 2 * outer) + 2 * outer * outer;
  static constexpr double low_outer = (1.0 / 6 - 1.0 / 9) / (outer_squares - 1.0 / 3);
  static constexpr std::array<double, size> low{
      1 - 3 * low_outer, low_outer, low_outer, low_outer, 0, 0, 0};
};

} // namespace umov
