#pragma once
// Private: errors with which a search looks.

#include <algorithm>
#include <cmath>
#include <umov/inverse/likelihood.h>
#include <umov/inverse/sample_errors.h>

namespace umov::inverse {

/// Mean of the measured I, at least 0: of a body that is dark but for a glint the median is none.
inline double mean_of_i(const ObservedCurve &curve) {
  double sum = 0, count = 0;
  for (const ObservedSample &s : curve.samples)
    if (!std::isnan(s.i)) {
      sum += s.i;
      count += 1;
    }
  return count > 0 ? std::max(sum / count, 0.0) : 0;
}

/// Errors of a model that may be off by `floor` of I and a part of a curve's typical I, half of it
/// in q and u: a glint narrower than the distance of what is looked at cannot veto it then, nor
/// light where there should be none. The floor forgives outliers too.
inline CurveErrors tempered(CurveErrors errors, const ObservedCurve &curve, double floor = 0.25) {
  errors.floor_q = std::hypot(errors.of_q(), floor / 2);
  errors.floor_median = std::hypot(errors.of_median(), floor / 2.5);
  errors.floor = std::hypot(errors.floor, floor);
  errors.median_i =
      std::max(errors.median_i > 0 ? errors.median_i : median_of_i(curve), mean_of_i(curve));
  errors.outlier_share = 0;
  return errors;
}

} // namespace umov::inverse
