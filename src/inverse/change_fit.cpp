#include "inverse/change_fit.h"

#include "algebra/dense.h"
#include "inverse/whitened.h"

#include <cmath>
#include <limits>

namespace umov::inverse {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_rounds = 60;
constexpr double least_share = 1e-9; // of a step

/// The last of the unknowns is one that the others leave something of: a pseudo-inverse has an
/// error for one that is not, too.
bool tells_last(const MatrixXd &normal) {
  const Index last = normal.rows() - 1;
  const VectorXd beside = normal.col(last).head(last);
  const VectorXd by = algebra::pseudo_inverse(normal.topLeftCorner(last, last)) * beside;
  constexpr double rounding = 1e-9;
  return normal(last, last) - beside.dot(by) > rounding * normal(last, last);
}

ChangeFit solved(const Whitened &w, const VectorXd &prior_weight) {
  ChangeFit out;
  MatrixXd normal = algebra::gram(w.columns);
  normal.diagonal() += prior_weight;
  out.is_told = normal.rows() < 2 || tells_last(normal);
  out.covariance = algebra::pseudo_inverse(normal);
  out.x = out.covariance * algebra::transposed_times(w.columns, w.right);
  out.chi2 = (w.right - w.columns * out.x).squaredNorm() +
             (prior_weight.array() * out.x.array().square()).sum();
  return out;
}

VectorXd priors_at(const ChangeProblem &problem, std::size_t members, double scale) {
  VectorXd out = VectorXd::Zero(static_cast<Index>(members));
  for (std::size_t k = 0; k < problem.unknown_sd.size(); ++k)
    out[static_cast<Index>(k + 1)] = 1 / std::pow(scale * problem.unknown_sd[k], 2);
  return out;
}

/// Chi-square of the parts themselves, with priors and zero points of the light from which a step
/// was made; infinite where they leave a row that was measured without light.
double chi2_of(const ChangeProblem &problem, const std::vector<EndMember> &members,
               const VectorXd &x, const VectorXd &prior_weight, const EndMember &from,
               std::size_t measurements) {
  const EndMember light = added_up(members, x);
  const Whitened w = whitened(problem.curve, problem.errors, {light}, &light, &from);
  if (w.measurements < measurements)
    return std::numeric_limits<double>::infinity();
  return (w.right - w.columns.col(0)).squaredNorm() +
         (prior_weight.array() * x.array().square()).sum();
}

/// The parts of the linear rows, or as far towards them from the object as it was as every row has
/// light.
VectorXd first_parts(const ChangeProblem &problem, const std::vector<EndMember> &members,
                     const VectorXd &linear, double scale, std::size_t measurements) {
  VectorXd before = VectorXd::Zero(linear.size());
  before[0] = scale;
  const VectorXd none = VectorXd::Zero(linear.size());
  for (double share = 1; share > least_share; share /= 2) {
    VectorXd out = share < 1 ? VectorXd(before + share * (linear - before)) : linear;
    if (chi2_of(problem, members, out, none, members.front(), measurements) <
        std::numeric_limits<double>::infinity())
      return out;
  }
  return before;
}

} // namespace

ObservedCurve where_lit(const ObservedCurve &curve, const EndMember &before) {
  ObservedCurve out = curve;
  for (ObservedSample &s : out.samples)
    if (!(before.i[s.epoch * curve.bands.size() + s.band] > 0))
      s.q = s.u = std::numeric_limits<double>::quiet_NaN();
  return out;
}

ChangeFit fit_changes(const ChangeProblem &problem, const std::vector<EndMember> &members) {
  const Whitened linear = whitened(problem.curve, problem.errors, members);
  const VectorXd alone = linear.columns.col(0);
  const double scale = alone.dot(linear.right) / alone.squaredNorm();
  ChangeFit out = solved(linear, priors_at(problem, members.size(), scale));
  out.x = first_parts(problem, members, out.x, scale, linear.measurements);
  // Levels of sufficient gain: Nocedal & Wright (2006), equation 3.4; the rest is for rounding.
  constexpr double least_gain = 1e-4, rounding = 1e-9;
  for (int round = 1; round <= most_rounds && out.x[0] > 0; ++round) {
    const VectorXd at = out.x;
    const EndMember about = added_up(members, at);
    const VectorXd prior = priors_at(problem, members.size(), at[0]);
    const auto chi2_at = [&](const VectorXd &x) {
      return chi2_of(problem, members, x, prior, about, linear.measurements);
    };
    out = solved(whitened(problem.curve, problem.errors, members, &about), prior);
    const VectorXd step = out.x - at;
    const double here = chi2_at(at), gain = here - out.chi2;
    double share = 1, there = chi2_at(out.x);
    while (!(there <= here - least_gain * share * gain + rounding * (1 + here)) &&
           share > least_share) {
      share /= 2;
      there = chi2_at(at + share * step);
    }
    out.is_settled = share == 1;
    if (out.is_settled && round >= refinements)
      break;
    if (out.is_settled)
      continue;
    const bool has_gained = share > least_share;
    out.x = has_gained ? VectorXd(at + share * step) : at;
    out.chi2 = has_gained ? there : here;
    if (!has_gained)
      break;
  }
  return out;
}

} // namespace umov::inverse
