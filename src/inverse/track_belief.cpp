#include "inverse/track_belief.h"

#include <cmath>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Belief belief_of(const TrackMode &mode) {
  const auto more = static_cast<Index>(mode.nuisances.size()), n = nuisances_at + more;
  Belief out{mode.turning.attitude, VectorXd::Zero(n),
             Eigen::Map<const MatrixXd>(mode.covariance.data(), n, n)};
  out.mean.segment<3>(rate_at) = eigen_of(mode.turning.rate_rad_s);
  for (Index k = 0; k < more; ++k)
    out.mean[nuisances_at + k] = mode.nuisances[static_cast<std::size_t>(k)];
  return out;
}

void put(const Belief &belief, TrackMode &mode) {
  const Belief now = reset(belief);
  const Quaternion q = now.attitude; // one of two signs, as tables have it
  mode.turning.attitude = q.w < 0 ? Quaternion{-q.w, -q.x, -q.y, -q.z} : q;
  mode.turning.rate_rad_s = vector_at(now.mean, rate_at);
  const double *const first = now.mean.data() + nuisances_at;
  mode.nuisances.assign(first, now.mean.data() + now.mean.size());
  mode.covariance.assign(now.covariance.data(), now.covariance.data() + now.covariance.size());
}

MatrixXd lower_root(const MatrixXd &m) {
  const Index n = m.rows();
  constexpr double rounding = 1e-13;     // of a variance: less of it is known exactly
  MatrixXd upper = MatrixXd::Zero(n, n); // transposed, so that products run along memory
  for (Index c = 0; c < n; ++c) {
    const double pivot = m(c, c) - upper.col(c).head(c).squaredNorm();
    if (!(pivot > rounding * m(c, c)))
      continue;
    const double root = upper(c, c) = std::sqrt(pivot);
    for (Index r = c + 1; r < n; ++r)
      upper(c, r) = (m(r, c) - upper.col(r).head(c).dot(upper.col(c).head(c))) / root;
  }
  return upper.transpose();
}

MatrixXd over_root(const MatrixXd &d, const MatrixXd &root) {
  const Index n = root.rows();
  MatrixXd out = MatrixXd::Zero(d.rows(), n);
  for (Index c = n - 1; c >= 0; --c) {
    if (!(root(c, c) > 0))
      continue;
    out.col(c) = d.col(c);
    for (Index r = c + 1; r < n; ++r)
      out.col(c) -= out.col(r) * root(r, c);
    out.col(c) /= root(c, c);
  }
  return out;
}

double square_in(const MatrixXd &root, VectorXd vector) {
  double out = 0;
  for (Index k = 0; k < vector.size(); ++k) { // forward substitution
    if (!(root(k, k) > 0))
      continue;
    const double length = vector[k] / root(k, k);
    vector.tail(vector.size() - k) -= length * root.col(k).tail(vector.size() - k);
    out += length * length;
  }
  return out;
}

double log_determinant(const MatrixXd &root) {
  double out = 0;
  for (Index k = 0; k < root.rows(); ++k)
    out += root(k, k) > 0 ? 2 * std::log(root(k, k)) : 0;
  return out;
}

Vec3<Body> vector_at(const VectorXd &unknowns, Index first) {
  return {unknowns[first], unknowns[first + 1], unknowns[first + 2]};
}

Quaternion attitude_of(const Belief &belief, const VectorXd &unknowns) {
  return turned(belief.attitude, vector_at(unknowns, turn_at));
}

namespace {

/// Small turns after a turn, by those before it: exp(v + d) = exp(v) exp(J d), the right Jacobian
/// of rotation vectors.
Eigen::Matrix3d right_jacobian(const Eigen::Vector3d &v) {
  const double angle = v.norm();
  Eigen::Matrix3d cross;
  cross << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  if (angle < 1e-6)
    return Eigen::Matrix3d::Identity() - cross / 2;
  const double square = angle * angle;
  return Eigen::Matrix3d::Identity() - cross * ((1 - std::cos(angle)) / square) +
         cross * cross * ((angle - std::sin(angle)) / (square * angle));
}

} // namespace

Belief reset(const Belief &belief) {
  Belief out = belief;
  const Eigen::Vector3d turn = belief.mean.segment<3>(turn_at);
  out.attitude = attitude_of(belief, belief.mean);
  out.mean.segment<3>(turn_at).setZero();
  const Eigen::Matrix3d by = right_jacobian(turn);
  const Eigen::Matrix<double, 3, Eigen::Dynamic> rows = by * belief.covariance.topRows<3>();
  out.covariance.topRows<3>() = rows;
  const Eigen::Matrix<double, Eigen::Dynamic, 3> columns =
      out.covariance.leftCols<3>() * by.transpose();
  out.covariance.leftCols<3>() = columns;
  out.covariance = ((out.covariance + out.covariance.transpose()) / 2).eval();
  return out;
}

std::vector<std::pair<double, Belief>> split(const Belief &belief, Index column) {
  constexpr double middle = 0.5495507502, side = 0.2252246249, narrower = 0.6715662887;
  // So that the three together are as wide as the one (DeMars et al. have 1.0575: less by 4.5 %).
  const double apart = std::sqrt((1 - narrower * narrower) / (2 * side));
  const VectorXd along = lower_root(belief.covariance).col(column);
  std::vector<std::pair<double, Belief>> out;
  for (const auto &[weight, shift] : {std::pair{side, -apart}, {middle, 0.0}, {side, apart}}) {
    Belief one = belief;
    one.mean += shift * along;
    one.covariance -= (1 - narrower * narrower) * along * along.transpose();
    out.emplace_back(weight, reset(one));
  }
  return out;
}

} // namespace umov::inverse
