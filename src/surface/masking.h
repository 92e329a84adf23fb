#pragma once
// Private: exact masking of one direction for an isotropic distribution without a closed form.

#include <functional>
#include <vector>

namespace umov {

/// P(k) = (n.k)/g(k) with g(k) = int D max(h.k, 0) dw (Smith's G1 of D; Ashikhmin, Premoze &
/// Shirley 2000). g is tabulated once, in u = n.k/limit because that is the scale on which it
/// bends, and read by a cubic through four points: within 2e-6 of the integral.
class Masking {
public:
  /// `density`: D as a function of cos(theta); `reach_rad`: beyond it D counts for nothing.
  Masking(const std::function<double(double)> &density, double reach_rad);
  /// n_k in [0, 1].
  [[nodiscard]] double operator()(double n_k) const;
  /// g(k) by direct integration, for tests and for the table.
  [[nodiscard]] static double integral(double n_k, const std::function<double(double)> &density,
                                       double reach_rad);

private:
  double limit_, per_cell_;
  std::vector<double> values_;
};

} // namespace umov
