#include <umov/inverse/health.h>

#include "algebra/dense.h"
#include "inverse/whitened.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What a unit of the parameter adds to the light.
EndMember slope_of(const LightChange &change, const EndMember &before) {
  EndMember out{change.name, {}, {}, {}};
  for (std::size_t k = 0; k < before.i.size(); ++k) {
    out.i.push_back((change.light.i[k] - before.i[k]) / change.step);
    out.q.push_back((change.light.q[k] - before.q[k]) / change.step);
    out.u.push_back((change.light.u[k] - before.u[k]) / change.step);
  }
  return out;
}

/// Columns added up with their parts of the first one.
EndMember mixed(const std::vector<EndMember> &members, const VectorXd &x) {
  EndMember out = members.front();
  for (std::size_t c = 1; c < members.size(); ++c) {
    const double part = x[static_cast<Index>(c)] / x[0];
    for (std::size_t k = 0; k < out.i.size() && part != 0; ++k) {
      out.i[k] += part * members[c].i[k];
      out.q[k] += part * members[c].q[k];
      out.u[k] += part * members[c].u[k];
    }
  }
  return out;
}

/// Least squares with priors as further rows: x, its covariance, and chi-square.
struct Fit {
  VectorXd x;
  MatrixXd covariance;
  double chi2 = 0;
};

Fit fit_of(const MatrixXd &columns, const VectorXd &right, const VectorXd &prior_weight) {
  Fit out;
  MatrixXd normal = algebra::gram(columns);
  normal.diagonal() += prior_weight;
  out.covariance = algebra::pseudo_inverse(normal);
  out.x = out.covariance * algebra::transposed_times(columns, right);
  out.chi2 = (right - columns * out.x).squaredNorm() +
             (prior_weight.array() * out.x.array().square()).sum();
  return out;
}

/// All changes at once: p = x_k / x_0, to first order in both.
void put_joint(const MatrixXd &columns, const VectorXd &right, const VectorXd &prior, Index fixed,
               Health &out) {
  const Fit fit = fit_of(columns, right, prior);
  const double x0 = std::max(fit.x[0], 1e-300);
  MatrixXd slope = MatrixXd::Zero(columns.cols() - fixed, columns.cols());
  for (Index k = 0; k < slope.rows(); ++k) {
    out.joint.push_back(fit.x[fixed + k] / x0);
    slope(k, 0) = -out.joint.back() / x0;
    slope(k, fixed + k) = 1 / x0;
  }
  const MatrixXd covariance =
      algebra::product(algebra::product(slope, fit.covariance), slope.transpose());
  for (Index r = 0; r < covariance.rows(); ++r)
    for (Index c = 0; c < covariance.cols(); ++c)
      out.joint_covariance.push_back(covariance(r, c));
}

/// Neither model nor data hold light: no change is seen, whatever it was.
Health dark(Health out, double chi2, const EndMember &before,
            const std::vector<LightChange> &changes) {
  out.chi2 = chi2;
  out.fitted = before;
  for (const LightChange &one : changes)
    out.rows.push_back({one.name});
  out.joint.assign(changes.size(), 0);
  out.joint_covariance.assign(changes.size() * changes.size(), 0);
  return out;
}

} // namespace

Health check_health(const ObservedCurve &curve, const CurveErrors &errors, const EndMember &before,
                    const std::vector<LightChange> &changes,
                    const std::vector<LightChange> &unknowns) {
  std::vector<EndMember> members{before};
  for (const LightChange &one : unknowns)
    members.push_back(slope_of(one, before));
  for (const LightChange &one : changes)
    members.push_back(slope_of(one, before));
  const auto w = inverse::whitened(curve, errors, members);
  const auto fixed = static_cast<Index>(1 + unknowns.size());
  Health out;
  out.measurements = w.measurements;
  if (!(w.columns.col(0).dot(w.right) > 0))
    return dark(std::move(out), w.right.squaredNorm(), before, changes);
  // The unknowns' columns are in units of the scale, which the object as it was tells well enough.
  const VectorXd alone = w.columns.col(0);
  const double scale = alone.dot(w.right) / alone.squaredNorm();
  VectorXd prior = VectorXd::Zero(fixed + 1);
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    prior[static_cast<Index>(k + 1)] = 1 / std::pow(scale * unknowns[k].sd, 2);
  MatrixXd columns(w.columns.rows(), fixed + 1);
  columns.leftCols(fixed) = w.columns.leftCols(fixed);
  const Fit unchanged = fit_of(columns.leftCols(fixed), w.right, prior.head(fixed));
  out.chi2 = unchanged.chi2;
  VectorXd best = VectorXd::Zero(static_cast<Index>(members.size()));
  best.head(fixed) = unchanged.x;
  double gain = 0;
  for (std::size_t k = 0; k < changes.size(); ++k) {
    columns.col(fixed) = w.columns.col(fixed + static_cast<Index>(k));
    const Fit fit = fit_of(columns, w.right, prior);
    HealthRow row;
    row.name = changes[k].name;
    if (!(fit.x[0] > 0)) { // of no light nothing can be a part
      out.rows.push_back(std::move(row));
      continue;
    }
    // p = x_p / x_0, to first order in both.
    const double x0 = fit.x[0];
    row.change = fit.x[fixed] / x0;
    const double variance = fit.covariance(fixed, fixed) -
                            2 * row.change * fit.covariance(0, fixed) +
                            row.change * row.change * fit.covariance(0, 0);
    row.change_err = std::sqrt(std::max(variance, 0.0)) / x0;
    row.sigma = row.change_err > 0 ? row.change / row.change_err : 0;
    row.detectable = 3 * row.change_err;
    row.chi2_gain = out.chi2 - fit.chi2;
    if (row.chi2_gain > gain) {
      gain = row.chi2_gain;
      best.setZero();
      best.head(fixed) = fit.x.head(fixed);
      best[fixed + static_cast<Index>(k)] = fit.x[fixed];
    }
    out.rows.push_back(std::move(row));
  }
  VectorXd all = VectorXd::Zero(w.columns.cols());
  all.head(fixed) = prior.head(fixed);
  put_joint(w.columns, w.right, all, fixed, out);
  best[0] = std::max(best[0], 1e-300);
  out.fitted = mixed(members, best);
  return out;
}

} // namespace umov
