#pragma once
// Private: exact masking of one direction for Blinn-Phong normals.

#include <vector>

namespace umov {

/// P(k) = <n.h>(n.k)/g(k) with g(k) = <max(h.k, 0)> (Ashikhmin, Premoze & Shirley 2000; it is
/// Smith's G1 of the same D). g is tabulated once, in u = n.k sqrt(m+2) because that is the scale
/// on which it bends, and read by a cubic through four points: within 2e-6 of the integral.
class Masking {
public:
  explicit Masking(double exponent);
  /// n_k in [0, 1].
  [[nodiscard]] double operator()(double n_k) const;
  /// g(k)/<n.h> by direct integration, for tests and for the table.
  [[nodiscard]] static double integral(double n_k, double exponent);

private:
  double scale_, limit_, per_cell_;
  std::vector<double> values_; ///< g/<n.h> at equal steps of u
};

} // namespace umov
