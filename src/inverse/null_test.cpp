#include <umov/inverse/null_test.h>

#include <Eigen/Dense>
#include <cmath>

namespace umov {

NullTest null_test(const ObservedCurve &curve, const std::vector<double> &model_u) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  NullTest out;
  for (std::size_t k = 0; k < curve.samples.size(); ++k) {
    const ObservedSample &s = curve.samples[k];
    if (std::isnan(s.u) || !(s.cov_uu > 0))
      continue;
    const double twice = 2 * curve.epochs[s.epoch].scattering_axis_rad;
    const Eigen::Vector2d row(-std::sin(twice), std::cos(twice));
    const double u = s.u - (model_u.empty() ? 0 : model_u[k]);
    normal += row * row.transpose() / s.cov_uu;
    right += row * u / s.cov_uu;
    ++out.measurements;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(normal);
  if (out.measurements == 0 || !(eigen.eigenvalues()[0] > 1e-9 * eigen.eigenvalues()[1]))
    return out;
  const Eigen::Matrix2d covariance = normal.inverse();
  const Eigen::Vector2d best = covariance * right;
  out.q0 = best[0];
  out.u0 = best[1];
  out.q0_sd = std::sqrt(covariance(0, 0));
  out.u0_sd = std::sqrt(covariance(1, 1));
  out.chi2_gain = right.dot(best);
  return out;
}

} // namespace umov
