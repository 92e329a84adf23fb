#include <umov/inverse/identify.h>

#include "inverse/quick_look.h"

#include <algorithm>
#include <cmath>
#include <umov/core/parallel.h>
#include <umov/inverse/attitude_grid.h>

namespace umov {

using inverse::QuickLook;

namespace {

/// Errors of a fit by a table: what lies between its nodes, and a tenth of the rows far off (lobes
/// narrower than a cell).
CurveErrors with_table(CurveErrors errors, const Signature &signature) {
  errors.floor = std::hypot(errors.floor, signature.error);
  errors.outlier_share = std::max(errors.outlier_share, 0.1);
  return errors;
}

/// The pose of a finalist, and its evidence in the measure of the data themselves.
Result<void> fit(const ObservedCurve &curve, const std::vector<std::size_t> &column,
                 const Signature &signature, const SearchOptions &search, IdentityCandidate &out) {
  SearchOptions own = search;
  own.errors = with_table(search.errors, signature);
  own.progress = {};
  own.starts = std::min<std::size_t>(own.starts, 40);
  const CurveModel model(curve, lighting_of(signature, search.threads), column);
  UMOV_ASSIGN(answer, search_pose(model, own));
  out.is_finalist = true;
  out.log_evidence = answer.log_evidence - CurveLikelihood(curve, own.errors).log_variance() / 2;
  out.chi2 = answer.chi2;
  out.measurements = answer.measurements;
  out.is_broad = answer.is_broad;
  if (!answer.modes.empty())
    out.attitude = answer.modes.front().turning.attitude;
  return {};
}

/// Evidence of an object akin to one of the library: of light that is 20 % off in each row, a mean
/// over the attitudes of a grid, which is fine enough for that.
Result<double> log_evidence_of_kin(const ObservedCurve &curve,
                                   const std::vector<std::size_t> &column,
                                   const Signature &signature, const IdentifyOptions &options) {
  constexpr double off = 0.2, off_median = 0.05;
  CurveErrors errors = with_table(options.search.errors, signature);
  errors.floor = std::hypot(errors.floor, off);
  errors.floor_median = std::hypot(errors.floor_median, off_median);
  const CurveLikelihood likelihood(curve, errors);
  const unsigned threads = options.search.threads;
  const CurveModel model(curve, lighting_of(signature, threads), column);
  std::vector<Turning> turnings;
  for (const Quaternion &q : attitude_grid(options.attitudes))
    turnings.push_back({q, {}});
  const auto compared = inverse::compare_all(model, likelihood, turnings, {}, threads);
  if (compared.empty())
    return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
  double best = 1e300, sum = 0;
  for (const Comparison &c : compared)
    best = std::min(best, c.minus_2_log);
  for (const Comparison &c : compared)
    sum += std::exp(-(c.minus_2_log - best) / 2);
  return std::log(sum / static_cast<double>(compared.size())) - best / 2 -
         likelihood.log_variance() / 2;
}

/// Evidence of none of them: of an object akin to any of the library alike. The three that fit best
/// stand for all; what others would add is small beside them.
Result<double> log_evidence_of_none(const ObservedCurve &curve,
                                    const std::vector<std::size_t> &column,
                                    std::span<const Signature> library,
                                    std::span<const IdentityCandidate> finalists,
                                    const IdentifyOptions &options) {
  constexpr std::size_t looked_at = 3;
  std::vector<IdentityCandidate> best(finalists.begin(), finalists.end());
  std::ranges::stable_sort(best, std::ranges::greater{}, &IdentityCandidate::log_evidence);
  std::vector<double> each;
  for (std::size_t k = 0; k < std::min(looked_at, best.size()); ++k) {
    UMOV_ASSIGN(one, log_evidence_of_kin(curve, column, library[best[k].which], options));
    each.push_back(one);
  }
  const double highest = *std::ranges::max_element(each);
  double sum = 0;
  for (const double one : each)
    sum += std::exp(one - highest);
  return highest + std::log(sum / static_cast<double>(library.size()));
}

/// Shares of what is probable, `none` among them.
void share(const IdentifyOptions &options, std::size_t library, IdentityAnswer &answer) {
  const double each = std::log((1 - options.none_prior) / static_cast<double>(library));
  const double none = std::log(options.none_prior) + answer.none_log_evidence;
  double highest = none;
  for (const IdentityCandidate &c : answer.candidates)
    if (c.is_finalist)
      highest = std::max(highest, each + c.log_evidence);
  answer.none = std::exp(none - highest);
  double sum = answer.none;
  for (IdentityCandidate &c : answer.candidates)
    sum += c.probability = c.is_finalist ? std::exp(each + c.log_evidence - highest) : 0;
  answer.none /= sum;
  for (IdentityCandidate &c : answer.candidates)
    c.probability /= sum;
}

} // namespace

Result<IdentityAnswer> identify(const ObservedCurve &curve, const std::vector<std::size_t> &column,
                                std::span<const Signature> library,
                                const IdentifyOptions &options) {
  if (library.empty())
    return fail(ErrorCode::Usage, "a library without objects: nothing can be named");
  if (std::ranges::none_of(curve.samples, [](const ObservedSample &s) { return s.i > 0; }))
    return fail(ErrorCode::BadInput,
                "no row has light above 0: objects are told apart by brightness and its changes, "
                "colours, and q in parts of it");
  IdentityAnswer out;
  out.candidates.resize(library.size());
  const SearchOptions &search = options.search;
  const QuickLook look(curve, column, library.front().cells, options.attitudes, search.threads);
  constexpr std::size_t together = 16; // between two signs of life
  for (std::size_t begin = 0; begin < library.size(); begin += together) {
    if (search.progress)
      search.progress("first look", begin, library.size());
    parallel_for(std::min(together, library.size() - begin), search.threads, [&](std::size_t k) {
      IdentityCandidate &one = out.candidates[begin + k];
      one.which = begin + k;
      one.rank_score =
          look.score(library[begin + k], with_table(search.errors, library[begin + k]));
    });
  }
  std::ranges::stable_sort(out.candidates, {}, &IdentityCandidate::rank_score);
  const std::size_t finalists = std::min(options.finalists, out.candidates.size());
  for (std::size_t k = 0; k < finalists; ++k) {
    if (search.progress)
      search.progress("finalists", k, finalists);
    UMOV_TRY(fit(curve, column, library[out.candidates[k].which], search, out.candidates[k]));
  }
  UMOV_ASSIGN(none, log_evidence_of_none(curve, column, library,
                                         std::span(out.candidates).first(finalists), options));
  out.none_log_evidence = none;
  share(options, library.size(), out);
  std::ranges::stable_sort(out.candidates.begin(),
                           out.candidates.begin() + static_cast<std::ptrdiff_t>(finalists),
                           std::ranges::greater{}, &IdentityCandidate::probability);
  return out;
}

} // namespace umov
