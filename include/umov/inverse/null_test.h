#pragma once
// What a single reflection cannot give: U in the scattering plane.

#include <umov/inverse/observed_curve.h>

namespace umov {

/// Whether measured u_scat asks for polarization that stays in the instrument's frame.
struct NullTest {
  double q0 = 0, u0 = 0;       ///< best constant polarization in the frame of the instrument
  double q0_sd = 0, u0_sd = 0; ///< 0: the curve does not tell
  double chi2_gain = 0;        ///< against none: chi-square with two degrees of freedom
  std::size_t measurements = 0;
  /// Less likely than 1 in 100 by chance.
  [[nodiscard]] bool is_flagged() const { return measurements > 2 && chi2_gain > 9.2103; }
};

/// Fits a constant (q0, u0) of the frame of the observations to u_scat = u0 cos 2a - q0 sin 2a,
/// where a single reflection leaves 0; `model_u`, of all samples in order, is taken off first.
NullTest null_test(const ObservedCurve &curve, const std::vector<double> &model_u = {});

} // namespace umov
