#pragma once
// Private: the best sum of members of light to a curve, unknowns under priors.

#include <Eigen/Core>
#include <umov/inverse/unmix.h>

namespace umov::inverse {

/// Curve, errors and what its light is added up from: the object as it was, unknowns with their
/// priors, changes. q and u stand only where the object as it was gives light (`where_lit`).
struct ChangeProblem {
  const ObservedCurve &curve;
  const CurveErrors &errors;
  std::vector<double> unknown_sd;
};

/// Least squares with priors as further rows: parts, their covariance, and chi-square.
struct ChangeFit {
  Eigen::VectorXd x;
  Eigen::MatrixXd covariance;
  double chi2 = 0;
  bool is_settled = true; ///< false: the best parts would leave a row without light
  bool is_told = true;    ///< false: the others can do what the last member does
};

/// The curve without q and u of samples in which the object as it was is dark: no step may add or
/// lose a measurement, or chi-squares of two fits could not be compared.
ObservedCurve where_lit(const ObservedCurve &curve, const EndMember &before);

/// The best parts of the members: Gauss-Newton with steps that are halved until they gain and leave
/// every row of q and u its light. The unknowns' parts are in units of the scale, so their priors
/// are too. Where the data ask for no light at all, x[0] is 0 or less.
ChangeFit fit_changes(const ChangeProblem &problem, const std::vector<EndMember> &members);

} // namespace umov::inverse
