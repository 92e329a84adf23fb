// A filter between epochs: the body turns at its rate, which walks at random.

#include "inverse/track_belief.h"

#include <algorithm>
#include <cmath>
#include <umov/inverse/attitude_grid.h>

namespace umov {
namespace inverse {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Turns by the rate, by sigma points at sqrt(3) standard deviations with their second differences
/// (Norgaard, Poulsen & Ravn 2000, Automatica 36, 1627): no weight of theirs is negative, however
/// many unknowns there are.
void turn_on(Belief &belief, double seconds) {
  const MatrixXd root = lower_root(belief.covariance);
  const double h = std::sqrt(3.0);
  const auto later = [&](const VectorXd &x) {
    return turned(attitude_of(belief, x), vector_at(x, rate_at) * seconds);
  };
  const Quaternion middle = later(belief.mean);
  MatrixXd moved = root;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Eigen::Matrix3d bent = Eigen::Matrix3d::Zero();
  for (Index c = 0; c < nuisances_at; ++c) { // those behind move nothing
    const Eigen::Vector3d up = eigen_of(turn_between(middle, later(belief.mean + h * root.col(c))));
    const Eigen::Vector3d down =
        eigen_of(turn_between(middle, later(belief.mean - h * root.col(c))));
    moved.col(c).segment<3>(turn_at) = (up - down) / (2 * h);
    const Eigen::Vector3d second = (up + down) / (h * h);
    shift += second / 2;
    bent += second * second.transpose() / 2;
  }
  belief.covariance = moved * moved.transpose();
  belief.covariance.topLeftCorner<3, 3>() += bent;
  belief.attitude = middle;
  belief.mean.segment<3>(turn_at) = shift;
}

/// Random walk of the rate over some seconds, in which the body turns by little.
void add_walk(Belief &belief, double seconds, double rate_noise) {
  const double per_s = rate_noise * rate_noise;
  for (Index k = 0; k < 3; ++k) {
    belief.covariance(k, k) += per_s * seconds * seconds * seconds / 3;
    belief.covariance(k, rate_at + k) += per_s * seconds * seconds / 2;
    belief.covariance(rate_at + k, k) += per_s * seconds * seconds / 2;
    belief.covariance(rate_at + k, rate_at + k) += per_s * seconds;
  }
}

} // namespace
} // namespace inverse

TrackMode turned_on(const TrackMode &mode, double seconds, double rate_noise) {
  inverse::Belief belief = inverse::belief_of(mode);
  // Where a walk turns with the body, in steps of a quarter radian.
  constexpr double step_rad = 0.25, most = 4096;
  const double turn = norm(mode.turning.rate_rad_s) * std::abs(seconds);
  const auto steps =
      rate_noise > 0 ? static_cast<int>(std::clamp(std::ceil(turn / step_rad), 1.0, most)) : 1;
  for (int k = 0; k < steps; ++k) {
    inverse::turn_on(belief, seconds / steps);
    inverse::add_walk(belief, std::abs(seconds) / steps, rate_noise);
    belief = inverse::reset(belief);
  }
  TrackMode out = mode;
  inverse::put(belief, out);
  return out;
}

} // namespace umov
