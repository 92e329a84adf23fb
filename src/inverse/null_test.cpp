#include <umov/inverse/null_test.h>

#include <cmath>

namespace umov {

NullTest null_test(const ObservedCurve &curve, const std::vector<double> &model_u) {
  double qq = 0, qu = 0, uu = 0; // of the normal equations
  double of_q = 0, of_u = 0;
  NullTest out;
  for (std::size_t k = 0; k < curve.samples.size(); ++k) {
    const ObservedSample &s = curve.samples[k];
    if (std::isnan(s.u) || !(s.cov_uu > 0))
      continue;
    const double twice = 2 * curve.epochs[s.epoch].scattering_axis_rad;
    const double by_q = -std::sin(twice), by_u = std::cos(twice);
    const double u = s.u - (model_u.empty() ? 0 : model_u[k]);
    qq += by_q * by_q / s.cov_uu;
    qu += by_q * by_u / s.cov_uu;
    uu += by_u * by_u / s.cov_uu;
    of_q += by_q * u / s.cov_uu;
    of_u += by_u * u / s.cov_uu;
    ++out.measurements;
  }
  // Less than 1e-9 of the larger eigenvalue: one direction is all that was measured.
  const double middle = (qq + uu) / 2, apart = std::hypot((qq - uu) / 2, qu);
  if (out.measurements == 0 || !(middle - apart > 1e-9 * (middle + apart)))
    return out;
  const double determinant = qq * uu - qu * qu;
  out.q0 = (uu * of_q - qu * of_u) / determinant;
  out.u0 = (qq * of_u - qu * of_q) / determinant;
  out.q0_sd = std::sqrt(uu / determinant);
  out.u0_sd = std::sqrt(qq / determinant);
  out.chi2_gain = of_q * out.q0 + of_u * out.u0;
  return out;
}

} // namespace umov
