#pragma once
// Private: what one filter takes its unknowns for, and sigma points of it.

#include "inverse/turning_step.h"

#include <umov/inverse/track.h>

namespace umov::inverse {

/// Normal about a mean. Unknowns: rotation vector in body axes from `attitude` [rad], rate [rad/s],
/// nuisances.
struct Belief {
  Quaternion attitude;
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};
/// The attitude's and the rate's places among them.
inline constexpr Eigen::Index turn_at = 0, rate_at = 3, nuisances_at = 6;

Belief belief_of(const TrackMode &mode);
void put(const Belief &belief, TrackMode &mode);

/// Lower triangular L with L L^T = m; what is known exactly has a column of zeros.
Eigen::MatrixXd lower_root(const Eigen::MatrixXd &m);
/// a with a L = d, 0 where L has a column of zeros.
Eigen::MatrixXd over_root(const Eigen::MatrixXd &d, const Eigen::MatrixXd &root);

/// Square of a vector in standard deviations of the covariance of a root, left out what that has
/// zeros for.
double square_in(const Eigen::MatrixXd &root, Eigen::VectorXd vector);
/// ln of the determinant of that covariance, less what it has zeros for.
double log_determinant(const Eigen::MatrixXd &root);

/// Three components of the unknowns, from `first` on.
Vec3<Body> vector_at(const Eigen::VectorXd &unknowns, Eigen::Index first);
/// The attitude of some unknowns.
Quaternion attitude_of(const Belief &belief, const Eigen::VectorXd &unknowns);
/// The mean turn becomes part of the attitude, and the covariance is of turns from there (Markley
/// 2003, J. Guidance 26, 311).
Belief reset(const Belief &belief);
/// The belief as three narrower ones along a column of its root, with their weights: the mixture
/// nearest to a normal of their width (DeMars, Bishop & Jah 2013, J. Guidance 36, 1047).
std::vector<std::pair<double, Belief>> split(const Belief &belief, Eigen::Index column);

} // namespace umov::inverse
