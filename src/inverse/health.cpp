#include <umov/inverse/health.h>

#include "algebra/dense.h"
#include "inverse/change_fit.h"
#include "inverse/whitened.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using inverse::ChangeFit;
using inverse::ChangeProblem;
using inverse::fit_changes;

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
  const double whole = std::max(x[0], 1e-300);
  for (std::size_t c = 1; c < members.size(); ++c) {
    const double part = x[static_cast<Index>(c)] / whole;
    for (std::size_t k = 0; k < out.i.size() && part != 0; ++k) {
      out.i[k] += part * members[c].i[k];
      out.q[k] += part * members[c].q[k];
      out.u[k] += part * members[c].u[k];
    }
  }
  return out;
}

/// The last of the parts as a change: p = x_p / x_0, to first order in both.
void put_change(const ChangeFit &fit, double chi2_without, HealthRow &row) {
  if (!fit.is_told)
    return;
  const Index last = fit.x.size() - 1;
  const double x0 = fit.x[0];
  row.change = fit.x[last] / x0;
  const double variance = fit.covariance(last, last) - 2 * row.change * fit.covariance(0, last) +
                          row.change * row.change * fit.covariance(0, 0);
  row.change_err = std::sqrt(std::max(variance, 0.0)) / x0;
  row.sigma = row.change_err > 0 ? row.change / row.change_err : 0;
  row.detectable = 3 * row.change_err;
  row.chi2_gain = chi2_without - fit.chi2;
  row.is_settled = fit.is_settled;
}

/// All changes at once: p = x_k / x_0, to first order in both.
void put_joint(const ChangeProblem &problem, const std::vector<EndMember> &members, Health &out) {
  const ChangeFit fit = fit_changes(problem, members);
  const auto fixed = static_cast<Index>(1 + problem.unknown_sd.size());
  const double x0 = std::max(fit.x[0], 1e-300);
  MatrixXd slope = MatrixXd::Zero(fit.x.size() - fixed, fit.x.size());
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

/// Model or data hold no light above the errors: no change is seen, whatever it was.
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
  const ObservedCurve lit = inverse::where_lit(curve, before);
  ChangeProblem problem{lit, errors, {}};
  for (const LightChange &one : unknowns) {
    members.push_back(slope_of(one, before));
    problem.unknown_sd.push_back(one.sd);
  }
  const std::size_t fixed = members.size();
  Health out;
  const auto w = inverse::whitened(lit, errors, {before});
  out.measurements = w.measurements;
  if (!w.shows.front())
    return dark(std::move(out), w.right.squaredNorm(), before, changes);
  const ChangeFit unchanged = fit_changes(problem, members);
  out.chi2 = unchanged.chi2;
  out.fitted = mixed(members, unchanged.x);
  double gain = 0;
  for (const LightChange &change : changes) {
    members.resize(fixed);
    members.push_back(slope_of(change, before));
    const ChangeFit fit = fit_changes(problem, members);
    HealthRow row;
    row.name = change.name;
    if (fit.x[0] > 0) // of no light nothing can be a part
      put_change(fit, out.chi2, row);
    if (row.chi2_gain > gain) {
      gain = row.chi2_gain;
      out.fitted = mixed(members, fit.x);
    }
    out.rows.push_back(std::move(row));
  }
  members.resize(fixed);
  for (const LightChange &change : changes)
    members.push_back(slope_of(change, before));
  put_joint(problem, members, out);
  return out;
}

} // namespace umov
