#pragma once
// How well a sample is known, its own errors and the model's together:
// docs/theory/inverse.md, equation 4. The one place that says so.

#include <umov/inverse/likelihood.h>

namespace umov::inverse {

/// Of one sample.
struct SampleErrors {
  double i_variance = 0; ///< of I; 0: I was not measured, or is no measurement
  /// Rows of the inverse square root of the covariance of (q, u): L^-1 (q, u) has unit covariance;
  /// all 0: not measured.
  double l_qq = 0, l_uq = 0, l_uu = 0;
  /// ln of the variances of what was measured, added up.
  double log_variance = 0;
};

/// `median_i`: of the measured I of the curve.
SampleErrors errors_of(const ObservedSample &sample, const CurveErrors &errors, double median_i);
/// Median of the measured I; 0 if there is none.
double median_of_i(const ObservedCurve &curve);

} // namespace umov::inverse
