#include <umov/inverse/contributions.h>

#include "algebra/dense.h"
#include "inverse/neighbours.h"
#include "inverse/turning_fit.h"

#include <map>

namespace umov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Derived {
  std::vector<double> residuals;
  MatrixXd jacobian;
};

/// Residuals at a mode and their derivatives; no residuals if it was stopped.
Derived derive(const PoseMode &mode, const CurveModel &model, const CurveLikelihood &likelihood,
               unsigned threads) {
  using namespace inverse;
  const std::vector<Comparison> at =
      compare_all(model, likelihood, {{mode.turning}}, {}, threads, true);
  if (at.empty())
    return {};
  const bool has_rates = mode.covariance.size() > 9;
  const double span = span_of(model.curve());
  const auto around = Neighbours::alike(has_rates ? 6 : 3, FitPlan().difference_rad);
  std::vector<Turning> near;
  for (std::size_t k = 0; k < around.count(); ++k)
    near.push_back(stepped(mode.turning, around.step(k), span));
  const std::vector<std::span<const double>> parts(near.size(), at.front().off);
  const auto beside = compare_all(model, likelihood, near, {}, threads, true, parts);
  if (beside.empty())
    return {};
  std::vector<const std::vector<double> *> residuals;
  for (const Comparison &one : beside)
    residuals.push_back(&one.residuals);
  return {at.front().residuals, around.jacobian(at.front().residuals, residuals)};
}

} // namespace

std::vector<Contribution> contributions_to(const PoseAnswer &answer, const CurveModel &model,
                                           unsigned threads) {
  if (answer.modes.empty())
    return {};
  const CurveLikelihood likelihood(model.curve(), answer.errors);
  const auto [residuals, jacobian] = derive(answer.modes.front(), model, likelihood, threads);
  if (residuals.empty())
    return {};
  const MatrixXd information = algebra::gram(jacobian);
  const VectorXd values = algebra::singular_values(information);
  constexpr double rounding = 1e-9;
  if (!(values[values.size() - 1] > rounding * values[0]))
    return {};
  const MatrixXd covariance = algebra::pseudo_inverse(information);
  const auto unknowns = static_cast<double>(jacobian.cols());
  std::map<std::pair<std::size_t, CurveLikelihood::Measured>, Contribution> out;
  const auto numbers = likelihood.numbers();
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto [what, band] = numbers[k];
    if (what == CurveLikelihood::Measured::Nothing)
      continue;
    Contribution &one = out[{band, what}];
    one.band = band;
    one.what = what;
    ++one.numbers;
    one.chi2 += residuals[k] * residuals[k];
    const auto row = jacobian.row(static_cast<Index>(k));
    one.share += row.dot(covariance * row.transpose()) / unknowns;
  }
  std::vector<Contribution> sorted;
  for (const auto &[key, one] : out)
    sorted.push_back(one);
  return sorted;
}

} // namespace umov
