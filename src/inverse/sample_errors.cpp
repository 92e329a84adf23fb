#include <umov/inverse/sample_errors.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace umov::inverse {

SampleErrors errors_of(const ObservedSample &sample, const CurveErrors &errors, double median_i) {
  SampleErrors out;
  // A gain per epoch takes no zero points beside it: they are counted as errors of their own.
  const double part =
      errors.has_clouds ? std::hypot(errors.floor, errors.zero_point_sd) : errors.floor;
  const double base = errors.of_median() * median_i;
  const double of_model = std::max(part, best_relative) * std::max(0.0, sample.i);
  const double told = sample.i_sd * sample.i_sd + of_model * of_model + base * base;
  // What is dark and has no error, of a model without any, is a measurement all the same.
  const double least = best_relative * median_i, variance = told > 0 ? told : least * least;
  if (!std::isnan(sample.i) && variance > 0) {
    out.i_variance = variance;
    out.log_variance += std::log(variance);
  }
  if (errors.has_polarization && !std::isnan(sample.q)) {
    const double more = errors.of_q() * errors.of_q(), least = best_relative * best_relative;
    // Cholesky of the covariance, inverted.
    const double a = std::sqrt(std::max(sample.cov_qq + more, least)), b = sample.cov_qu / a;
    const double c = std::sqrt(std::max(sample.cov_uu + more - b * b, least));
    out.l_qq = 1 / a;
    out.l_uu = 1 / c;
    out.l_uq = -b / (a * c);
    out.log_variance += 2 * std::log(a * c);
  }
  return out;
}

double median_of_i(const ObservedCurve &curve) {
  std::vector<double> measured;
  for (const ObservedSample &s : curve.samples)
    if (!std::isnan(s.i))
      measured.push_back(s.i);
  if (measured.empty())
    return 0;
  const auto middle = measured.begin() + static_cast<std::ptrdiff_t>(measured.size() / 2);
  std::nth_element(measured.begin(), middle, measured.end());
  return *middle;
}

} // namespace umov::inverse
