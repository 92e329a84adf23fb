#include "inverse/identity_evidence.h"

#include "inverse/turning_fit.h"

#include <algorithm>
#include <cmath>

namespace umov::inverse {
namespace {

/// How far the light of a signature may be off for one curve: what its file tells is for all
/// directions together, and a curve sees few of them. The same steps for all candidates, so that
/// none wins by the size of its errors.
constexpr double table_levels[] = {0.0125, 0.025, 0.05, 0.1, 0.2, 0.4};

/// The least level that is no less than what a file tells.
std::size_t level_of(double error) {
  std::size_t k = 0;
  while (k + 1 < std::size(table_levels) && table_levels[k] < error)
    ++k;
  return k;
}

/// Errors of light that is looked up between the nodes of a signature: of a few rows, glints
/// between nodes, much more than of the others. Q/I is smoother than I.
CurveErrors of_table(CurveErrors errors, double table) {
  constexpr double q_error = 0.01, dim = 3, glints = 0.05;
  errors.floor_q = std::hypot(errors.of_q(), q_error);
  errors.floor_median = std::hypot(errors.of_median(), table / dim);
  errors.floor = std::hypot(errors.floor, table);
  errors.outlier_share = std::max(errors.outlier_share, glints);
  return errors;
}

double log_evidence_of(const CurveLikelihood &likelihood, const ModelLight &light) {
  return -(likelihood.compare(light).minus_2_log + likelihood.log_variance()) / 2;
}

/// Searches through a signature are smaller: it has no finer detail.
SearchOptions search_of_table(SearchOptions options) {
  constexpr std::size_t grid = 12'000, starts = 200, samples = 400;
  options.grid = std::min(options.grid, grid);
  options.starts = std::min(options.starts, starts);
  options.samples = std::min(options.samples, samples);
  options.progress = {};
  options.needs_set = false;
  return options;
}

} // namespace

double log_sum(double a, double b) {
  const double high = std::max(a, b), low = std::min(a, b);
  return high > least_log ? high + std::log1p(std::exp(low - high)) : least_log;
}

double log_of(double x) { return x > 0 ? std::log(x) : least_log; }

CurveErrors of_recoloured(CurveErrors errors) {
  constexpr double colour = 0.3;
  errors.zero_point_sd = std::hypot(errors.zero_point_sd, colour);
  return errors;
}

CurveErrors of_kin(CurveErrors errors) {
  constexpr double off = 0.25, off_median = 0.1, q_off = 0.03;
  errors.floor_q = std::hypot(errors.of_q(), q_off);
  errors.floor_median = std::hypot(errors.of_median(), off_median);
  errors.floor = std::hypot(errors.floor, off);
  return errors;
}

double featureless(const ObservedCurve &curve, CurveErrors errors) {
  errors.zero_point_sd = 1;
  const CurveLikelihood likelihood(curve, errors);
  const std::size_t bands = curve.bands.size();
  std::vector<double> even(curve.epochs.size() * bands, 1), sphere = even, none(even.size(), 0);
  for (std::size_t e = 0; e < curve.epochs.size(); ++e) {
    const double c = std::clamp(dot(curve.epochs[e].to_sun, curve.epochs[e].to_observer), -1., 1.);
    const double a = std::acos(c);
    for (std::size_t b = 0; b < bands; ++b)
      sphere[e * bands + b] = (std::sin(a) + (pi - a) * c) / pi;
  }
  return log_sum(log_evidence_of(likelihood, {even, none, none}),
                 log_evidence_of(likelihood, {sphere, none, none})) -
         std::log(2.0);
}

Result<double> mean_evidence(const CurveModel &model, const CurveLikelihood &likelihood,
                             const std::vector<Turning> &best, std::span<const std::size_t> epochs,
                             std::size_t of, unsigned threads) {
  const auto compared = compare_all(model, likelihood, best, epochs, threads);
  if (compared.empty())
    return tl::unexpected(stopped());
  double least = 1e300, sum = 0;
  for (const Comparison &one : compared)
    least = std::min(least, one.minus_2_log);
  for (const Comparison &one : compared)
    sum += std::exp(-(one.minus_2_log - least) / 2);
  return -(least + likelihood.log_variance()) / 2 + std::log(sum / static_cast<double>(of));
}

Result<double> table_peak(const CurveModel &model, const CurveErrors &errors, double table_error,
                          const std::vector<Turning> &best, std::span<const std::size_t> epochs,
                          unsigned threads) {
  // As in a search: a likelihood that a glint cannot veto first, then the table's own.
  constexpr std::size_t starts = 60, kept = 12;
  constexpr double apart = 5 * degree;
  const std::size_t largest = level_of(table_error);
  const CurveLikelihood rough(model.curve(), of_kin(errors), epochs);
  const CurveLikelihood last(model.curve(), of_table(errors, table_levels[largest]), epochs);
  auto fits = fit_turnings(model, rough, spread_out(best, starts, apart), epochs,
                           on_the_way(4, 2e-3, threads));
  fits = fit_turnings(model, last, turnings_of(fits, kept), epochs, on_the_way(12, 1e-3, threads));
  if (fits.empty())
    return tl::unexpected(stopped());
  const auto at = turnings_of(fits, kept);
  double out = least_log;
  for (std::size_t level = 0; level <= largest; ++level) {
    const CurveLikelihood likelihood(model.curve(), of_table(errors, table_levels[level]), epochs);
    const auto compared = compare_all(model, likelihood, at, epochs, threads);
    if (compared.empty())
      return tl::unexpected(stopped());
    for (const Comparison &one : compared)
      out = std::max(out, -(one.minus_2_log + likelihood.log_variance()) / 2);
  }
  return out;
}

double independent_share(const ObservedCurve &curve, std::size_t cells) {
  double path = 0;
  for (std::size_t e = 1; e < curve.epochs.size(); ++e)
    for (const auto direction : {&ObservedEpoch::to_sun, &ObservedEpoch::to_observer})
      path += norm(curve.epochs[e].*direction - curve.epochs[e - 1].*direction);
  const double cell = pi / static_cast<double>(cells); // of an octahedron: 180 deg a side
  const auto epochs = static_cast<double>(std::max<std::size_t>(curve.epochs.size(), 1));
  return std::min(1.0, (1 + path / cell) / epochs);
}

double log_misfit(const PoseAnswer &answer) {
  const double dof =
      static_cast<double>(answer.measurements) - static_cast<double>(answer.unknowns);
  const double p = std::max(chi2_probability(answer.chi2, dof), 1e-300);
  return p < std::exp(-1) ? 1 + std::log(p) + std::log(-std::log(p)) : 0;
}

Result<double> table_evidence(const CurveModel &model, const SearchOptions &search,
                              double table_error, PoseAnswer &answer) {
  const std::size_t largest = level_of(table_error);
  const CurveErrors &errors = search.errors;
  SearchOptions options = search_of_table(search);
  options.errors = of_table(errors, table_levels[largest]);
  UMOV_ASSIGN(found, search_pose(model, options));
  answer = std::move(found);
  std::vector<Turning> at;
  at.reserve(answer.samples.size());
  for (const PoseSample &sample : answer.samples)
    at.push_back(sample.turning);
  double all = least_log;
  for (std::size_t level = 0; level <= largest; ++level) {
    const CurveLikelihood likelihood(model.curve(), of_table(errors, table_levels[level]));
    const auto compared = compare_all(model, likelihood, at, {}, options.threads);
    if (compared.empty())
      return tl::unexpected(stopped());
    double moved = least_log;
    for (std::size_t k = 0; k < at.size(); ++k)
      moved = log_sum(moved, log_of(answer.samples[k].weight) +
                                 (answer.samples[k].minus_2_log - compared[k].minus_2_log) / 2);
    all = log_sum(all, answer.log_evidence + moved - likelihood.log_variance() / 2);
  }
  return all - std::log(static_cast<double>(std::size(table_levels)));
}

} // namespace umov::inverse
