#include "inverse/pose_modes.h"

#include "algebra/dense.h"

#include <algorithm>
#include <cmath>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {
namespace {

/// Principal directions of what a fit leaves open, in the units of a step.
struct Spread {
  Eigen::VectorXd sd; ///< falling
  Eigen::MatrixXd directions;
};

Spread spread_of(const TurningFit &fit) {
  // No unknown is less certain than "anything", 0.8 rad either way.
  constexpr double widest = 0.8;
  const algebra::SymmetricEigen eigen = algebra::symmetric_eigen(fit.information);
  return {eigen.values.cwiseMax(1 / (widest * widest)).cwiseSqrt().cwiseInverse(), eigen.vectors};
}

std::vector<double> covariance_of(const Spread &spread, const Turning &about, double span_s) {
  const Eigen::MatrixXd root = spread.directions * spread.sd.asDiagonal();
  return out_of_steps(algebra::product(root, root.transpose()), about, span_s);
}

double log_det(const PoseMode &mode) {
  const auto n = static_cast<Eigen::Index>(std::lround(std::sqrt(mode.covariance.size())));
  return algebra::cholesky_root(Eigen::Map<const Eigen::MatrixXd>(mode.covariance.data(), n, n))
      .diagonal()
      .array()
      .log()
      .sum();
}

constexpr double dent = 1 * degree; // what roughness moves the end of a fit by

bool is_same_attitude(const PoseMode &better, const PoseMode &other) {
  return angle_between(better.turning.attitude, other.turning.attitude) <
         std::max(dent, 3 * std::min(better.sd_rad(), other.sd_rad()));
}

bool is_same_spin(const Turning &better, const Spread &spread, const Turning &other,
                  double span_s) {
  constexpr double along = 0.2; // rad: farther on a valley has bent by more than a dent
  const Step apart = step_between(better, other, spread.sd.size(), span_s);
  const Eigen::VectorXd by_direction = algebra::transposed_times(spread.directions, apart);
  Eigen::VectorXd limit = (3 * spread.sd).cwiseMax(dent);
  limit[0] = std::max(limit[0], along);
  return by_direction.cwiseQuotient(limit).squaredNorm() < 1;
}

} // namespace

std::vector<PoseMode> modes_of(const std::vector<TurningFit> &fits, double span_s) {
  constexpr std::size_t most = 120;
  std::vector<PoseMode> out;
  std::vector<Spread> spreads;
  double best = 1e300;
  for (const TurningFit &fit : fits)
    best = std::min(best, fit.at.minus_2_log);
  for (const TurningFit &fit : fits) {
    if (!(fit.at.minus_2_log <= best + 30)) // nor what is no number
      continue;
    Spread spread = spread_of(fit);
    PoseMode mode{
        fit.turning,     covariance_of(spread, fit.turning, span_s), 0, fit.at.chi2, fit.at.scale,
        fit.is_converged};
    bool is_known = false;
    for (std::size_t k = 0; k < out.size() && !is_known; ++k)
      is_known = spread.sd.size() < 6
                     ? is_same_attitude(out[k], mode)
                     : is_same_spin(out[k].turning, spreads[k], mode.turning, span_s);
    if (is_known)
      continue;
    mode.weight = std::exp(-(fit.at.minus_2_log - best) / 2 + log_det(mode));
    out.push_back(std::move(mode));
    spreads.push_back(std::move(spread));
    if (out.size() == most)
      break;
  }
  double sum = 0;
  for (const PoseMode &mode : out)
    sum += mode.weight;
  for (PoseMode &mode : out)
    mode.weight /= sum;
  return out;
}

} // namespace umov::inverse
