#include <umov/inverse/pose_search.h>

#include "algebra/dense.h"
#include "inverse/attitude_set.h"
#include "inverse/model_error.h"
#include "inverse/places.h"
#include "inverse/pose_modes.h"
#include "inverse/posterior.h"
#include "inverse/some_epochs.h"
#include "inverse/tempered.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <umov/inverse/attitude_grid.h>

namespace umov {

using inverse::degree;
using inverse::Freedom;
using inverse::Samples;
using inverse::stopped;
using inverse::tempered;
using inverse::TurningFit;

namespace {

/// How many times as many places a search of a short curve follows: it leaves more of them alike,
/// and they are lit the quicker.
std::size_t times_of(const ObservedCurve &curve) {
  constexpr std::size_t usual = 40, most = 4;
  return std::clamp<std::size_t>(usual / std::max<std::size_t>(curve.epochs.size(), 1), 1, most);
}

/// How many of the sorted chi2 hold all but a ten-thousandth of the probability: of faint light a
/// few epochs say little, and what a round throws away never comes back.
std::size_t plausible(const std::vector<double> &sorted) {
  constexpr double lost = 1e-4;
  double all = 0;
  for (const double chi2 : sorted)
    all += std::exp(-(chi2 - sorted.front()) / 2);
  double sum = 0;
  std::size_t count = 0;
  while (count < sorted.size() && sum < (1 - lost) * all)
    sum += std::exp(-(sorted[count++] - sorted.front()) / 2);
  return count;
}

/// Attitudes in order of chi2, after those that are plausible are left, `least` of them or more.
void keep_best(std::vector<Turning> &turnings, const std::vector<Comparison> &compared,
               std::size_t least) {
  std::vector<std::size_t> order(turnings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return compared[k].chi2; });
  std::vector<double> sorted;
  sorted.reserve(order.size());
  for (const std::size_t k : order)
    sorted.push_back(compared[k].chi2);
  const std::size_t kept = std::min(std::max(least, plausible(sorted)), order.size());
  std::vector<Turning> out;
  for (std::size_t k = 0; k < kept; ++k)
    out.push_back(turnings[order[k]]);
  turnings = std::move(out);
}

/// The grid, thinned out in three rounds: few epochs judge all attitudes, all epochs those left.
Result<std::vector<Turning>> search_grid(const CurveModel &model, const SearchOptions &options) {
  std::vector<Turning> left;
  for (const Quaternion &q : attitude_grid(options.grid))
    left.push_back({q, {}});
  struct Round {
    std::size_t epochs, part; ///< and which part of the grid is left after it
  };
  constexpr Round rounds[] = {{8, 6}, {20, 20}, {60, 40}};
  const CurveErrors errors = tempered(options.errors, model.curve());
  for (std::size_t r = 0; r < std::size(rounds); ++r) {
    if (options.progress)
      options.progress("search", r, std::size(rounds));
    const auto epochs = inverse::some_epochs(model.curve().epochs.size(), rounds[r].epochs);
    const CurveLikelihood likelihood(model.curve(), errors, epochs);
    const auto compared = inverse::compare_all(model, likelihood, left, epochs, options.threads);
    if (compared.empty())
      return tl::unexpected(stopped());
    keep_best(left, compared, std::max(options.grid / rounds[r].part, options.starts * 5 / 2));
    if (epochs.size() == model.curve().epochs.size() && r + 1 < std::size(rounds))
      break; // they were judged by all epochs
  }
  return left;
}

/// A few narrow peaks describe the posterior, and their samples bear it out.
bool is_described(const std::vector<PoseMode> &modes, const Samples &samples) {
  constexpr double widest = 10 * degree;
  constexpr double least = 60; // effective samples
  constexpr std::ptrdiff_t most = 8;
  constexpr double little = 1e-3; // what modes hold that do not count
  return samples.effective >= least &&
         std::ranges::count_if(modes, [](const PoseMode &m) { return m.weight > little; }) <=
             most &&
         std::ranges::none_of(
             modes, [](const PoseMode &m) { return m.weight > 0.01 && m.sd_rad() > widest; });
}

/// Fits that are taken to the end, of one place in fifty of the first.
constexpr std::size_t last_fits = 24;

/// How the last fits are run. Glints hold two directions a hundred times better than the third:
/// along such a valley, which bends, a dozen steps reach nothing.
inverse::FitPlan last_steps(Freedom freedom, const SearchOptions &options,
                            std::size_t kept = last_fits) {
  const bool has_rate = freedom == Freedom::AttitudeAndRate; // attitudes alone are lit quickly
  return {freedom, 200, 12, kept, 1e-3, options.threads, has_rate};
}

/// Peaks, and samples drawn from them.
struct Peaks {
  std::vector<PoseMode> modes;
  Samples samples;
  bool is_settled = true;
};

/// Draws that fit better than any of the fits: these had not come to rest, or missed a peak. What
/// counts is chi-square, which is what fits lessen: integrals over unknown parts move the peak of
/// the likelihood beside its bottom.
std::vector<Turning> better_draws(const Samples &samples, const std::vector<TurningFit> &fits) {
  constexpr double better = 1; // in chi-square, which masks make rough by less
  constexpr std::size_t most = 4;
  double best = 1e300;
  for (const TurningFit &fit : fits)
    best = std::min(best, fit.at.chi2);
  std::vector<PoseSample> found;
  for (const PoseSample &s : samples.draws)
    if (s.chi2 < best - better)
      found.push_back(s);
  std::ranges::stable_sort(found, {}, &PoseSample::chi2);
  std::vector<Turning> out;
  for (std::size_t k = 0; k < std::min(most, found.size()); ++k)
    out.push_back(found[k].turning);
  return out;
}

/// Samples around the fits, which go on from a draw that fits better.
Result<Peaks> peaks_of(const CurveModel &model, const CurveLikelihood &likelihood,
                       std::vector<TurningFit> fits, Freedom freedom,
                       const SearchOptions &options) {
  Peaks out;
  constexpr int rounds = 4;
  for (int round = 0;; ++round) {
    std::ranges::stable_sort(fits, {}, [](const TurningFit &f) { return f.at.minus_2_log; });
    out.modes = inverse::modes_of(fits, inverse::span_of(model.curve()));
    out.samples = inverse::sample_modes(model, likelihood, out.modes, options);
    if (out.samples.draws.empty())
      return tl::unexpected(stopped());
    const auto better = better_draws(out.samples, fits);
    out.is_settled = better.empty() && std::ranges::none_of(out.modes, [](const PoseMode &m) {
                       return m.weight > 0.01 && !m.is_converged;
                     });
    if (better.empty() || round + 1 == rounds)
      return out;
    auto more = inverse::fit_turnings(model, likelihood, better, {}, last_steps(freedom, options));
    if (more.empty())
      return tl::unexpected(stopped());
    fits.insert(fits.end(), more.begin(), more.end());
  }
}

/// Attitudes that were judged best, and of how many.
struct Judged {
  std::span<const Turning> best;
  std::size_t of = 0;
  /// Whether an attitude of that chi-square explains the curve. If none does there is no posterior
  /// to follow to all its places, and errors that are far too small make that a work of hours.
  std::function<bool(double chi2)> explains = {};
};

/// Takes away the turnings that a few epochs rule out by e^20 and more: each further row adds to
/// what speaks against them. Not of counts, whose variances are the model's. False if it was
/// stopped.
bool drop_hopeless(const CurveModel &model, const CurveLikelihood &likelihood, double log_evidence,
                   unsigned threads, std::vector<Turning> &turnings, std::vector<double> &weights) {
  constexpr std::size_t few = 8;
  constexpr double nothing = 20; // e-folds
  const std::size_t count = model.curve().epochs.size();
  if (!model.curve().counts.empty() || count <= 2 * few || turnings.empty())
    return true;
  const auto epochs = inverse::some_epochs(count, few);
  const CurveLikelihood some(model.curve(), likelihood.errors(), epochs);
  const auto compared = inverse::compare_all(model, some, turnings, epochs, threads);
  if (compared.empty())
    return false;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < compared.size(); ++k)
    if (!(compared[k].minus_2_log / 2 > nothing - log_evidence)) {
      turnings[kept] = turnings[k];
      weights[kept++] = weights[k];
    }
  turnings.resize(kept);
  weights.resize(kept);
  return true;
}

/// Evidence that judged attitudes hold away from all peaks, in parts of that of the peaks: where
/// little light was seen there are more peaks than fits. Less than 0 if it was stopped.
double evidence_beside(const CurveModel &model, const CurveLikelihood &likelihood,
                       const Peaks &peaks, const Judged &judged, unsigned threads) {
  std::vector<Turning> beside;
  const double cell = grid_spacing_rad(judged.of);
  for (const Turning &t : judged.best)
    if (std::ranges::none_of(peaks.modes, [&](const PoseMode &m) {
          return angle_between(m.turning.attitude, t.attitude) < std::max(cell, 3 * m.sd_rad());
        }))
      beside.push_back(t);
  if (beside.empty())
    return 0;
  // They come in order of likelihood: the first one by one, of what faint light leaves behind them
  // every nth.
  constexpr std::size_t each = 1500;
  const std::size_t stride =
      beside.size() > 2 * each ? (beside.size() - each + each - 1) / each : 1;
  std::vector<Turning> asked;
  std::vector<double> weights; // attitudes that each stands for
  for (std::size_t k = 0; k < beside.size(); k += k < each ? 1 : stride) {
    asked.push_back(beside[k]);
    weights.push_back(static_cast<double>(k < each ? 1 : stride));
  }
  if (!drop_hopeless(model, likelihood, peaks.samples.log_evidence, threads, asked, weights))
    return -1;
  if (asked.empty())
    return 0;
  const auto compared = inverse::compare_all(model, likelihood, asked, {}, threads);
  if (compared.empty())
    return -1;
  double out = 0;
  for (std::size_t k = 0; k < compared.size(); ++k)
    out += weights[k] *
           std::exp(std::min(-compared[k].minus_2_log / 2 - peaks.samples.log_evidence, 50.0));
  return out / static_cast<double>(judged.of);
}

/// `quick`: for what is looked at far from the peaks. `judged`: none where the fits came from
/// elsewhere than all attitudes.
Result<PoseAnswer> answer_of(const CurveModel &model, const CurveModel &quick,
                             const CurveLikelihood &likelihood, const std::vector<TurningFit> &fits,
                             Freedom freedom, const Judged &judged, const SearchOptions &options) {
  PoseAnswer out;
  UMOV_ASSIGN(peaks, peaks_of(model, likelihood, fits, freedom, options));
  out.chi2 = 1e300;
  for (const PoseMode &mode : peaks.modes)
    out.chi2 = std::min(out.chi2, mode.chi2);
  const bool is_explained = !judged.explains || judged.explains(out.chi2);
  const double beside =
      is_explained ? evidence_beside(quick, likelihood, peaks, judged, options.threads) : 0;
  if (beside < 0)
    return tl::unexpected(stopped());
  auto &[modes, samples, is_settled] = peaks;
  constexpr double much = 0.01; // a fifth of what a set of 95 % may leave out
  if (judged.of > 0 && is_explained && (beside > much || !is_described(modes, samples))) {
    Samples all = inverse::sample_all(quick, model, likelihood, modes, options);
    if (all.draws.empty())
      return tl::unexpected(stopped());
    // Either can miss probability, hardly find too much: peaks that particles lost on their way
    // lack in their evidence.
    constexpr double missed = 1; // e-fold
    out.is_broad = all.log_evidence > samples.log_evidence - missed;
    if (out.is_broad)
      samples = std::move(all);
    else if (beside > much)
      is_settled = false;
  }
  out.is_settled = is_settled || out.is_broad;
  out.effective = samples.effective;
  out.evidences_apart = samples.evidences_apart;
  if (judged.of > 0) // of all attitudes
    out.set95 = inverse::highest_density(samples.draws,
                                         out.is_broad ? std::span<const PoseMode>()
                                                      : std::span<const PoseMode>(modes),
                                         samples.runs)
                    .balls;
  std::ranges::stable_sort(modes, std::ranges::greater{}, &PoseMode::weight);
  out.modes = std::move(modes);
  out.samples = std::move(samples.draws);
  out.log_evidence = samples.log_evidence;
  out.measurements = likelihood.measurements();
  out.poses_lit = model.poses_lit() + (&quick == &model ? 0 : quick.poses_lit());
  return out;
}

} // namespace

double PoseMode::sd_rad() const {
  const auto n = static_cast<Eigen::Index>(std::lround(std::sqrt(covariance.size())));
  const Eigen::MatrixXd all = Eigen::Map<const Eigen::MatrixXd>(covariance.data(), n, n);
  return std::sqrt(algebra::symmetric_eigen(all.topLeftCorner(3, 3)).values[2]);
}

bool explains_nothing(const PoseAnswer &answer, double floor) {
  const double dof =
      static_cast<double>(answer.measurements) - static_cast<double>(answer.unknowns);
  constexpr double unlikely = 1e-6; // and a model twice as far off as it was taken to be
  constexpr double none = 4, least = 0.005;
  return (dof > 0 && chi2_probability(answer.misfit, dof) < unlikely && answer.misfit > 2 * dof) ||
         answer.model_error > none * std::max(floor, least);
}

Result<PoseAnswer> search_pose(const CurveModel &model, const SearchOptions &options) {
  return search_pose({model, model, model}, options);
}

namespace {

constexpr std::size_t of_attitude = 4; ///< unknowns: attitude and scale

/// The errors that the best of some fits leave, and the likelihood of them.
class FoundErrors {
public:
  FoundErrors(const CurveModel &model, const SearchOptions &options)
      : model_(model), options_(options), error_{options.errors, 0, 1, 0},
        likelihood_(model.curve(), options.errors) {}
  /// Asks the data; false if it was stopped. `changed`: by more than the data can tell.
  bool ask(std::span<const Turning> best, bool &changed) {
    changed = false;
    if (!(options_.largest_floor > options_.errors.floor))
      return true;
    constexpr std::size_t few = 5;
    inverse::ModelError found;
    if (!inverse::find_model_error(model_, options_.errors, options_.largest_floor,
                                   best.first(std::min(few, best.size())), options_.threads, found))
      return false;
    constexpr double much = 1.15;
    const double times = found.errors.floor / std::max(error_.errors.floor, 1e-9);
    changed = times > much || times < 1 / much;
    error_ = found;
    likelihood_ = CurveLikelihood(model_.curve(), found.errors);
    return true;
  }
  [[nodiscard]] const CurveLikelihood &likelihood() const { return likelihood_; }
  /// Whether an attitude of that chi-square explains the curve.
  [[nodiscard]] bool explain(double chi2) const {
    PoseAnswer best;
    best.chi2 = chi2;
    best.measurements = likelihood_.measurements();
    best.unknowns = of_attitude;
    tell(best);
    return !explains_nothing(best, options_.errors.floor);
  }
  void tell(PoseAnswer &answer) const {
    answer.errors = error_.errors;
    answer.model_error = error_.found;
    answer.is_model_error_more = error_.found > 0 && error_.found >= options_.largest_floor;
    answer.related = error_.related;
    answer.misfit = error_.found > 0 ? error_.chi2 : answer.chi2;
  }

private:
  const CurveModel &model_;
  const SearchOptions &options_;
  inverse::ModelError error_;
  CurveLikelihood likelihood_;
};

/// The last steps, until the errors that they leave are those that they were taken with.
Result<std::vector<TurningFit>> settled_fits(const CurveModel &model, std::vector<Turning> from,
                                             Freedom freedom, std::size_t kept, FoundErrors &errors,
                                             const SearchOptions &options) {
  constexpr int rounds = 3;
  for (int round = 0;; ++round) {
    auto fits = inverse::fit_turnings(model, errors.likelihood(), from, {},
                                      last_steps(freedom, options, kept));
    if (fits.empty())
      return tl::unexpected(stopped());
    from = inverse::turnings_of(fits, kept);
    bool has_changed = false;
    if (round + 1 == rounds)
      return fits;
    if (!errors.ask(from, has_changed))
      return tl::unexpected(stopped());
    if (!has_changed)
      return fits;
  }
}

} // namespace

namespace {

/// Few that stand for all epochs where many attitudes are fitted.
std::vector<std::size_t> epochs_of_first_steps(const CurveModel &model) {
  return inverse::epochs_out_of_step(model.curve().epochs.size(), 60);
}

/// How much of the places a search goes after.
struct Effort {
  std::size_t times = 1;        ///< as many places as usual
  std::size_t kept = last_fits; ///< fits that are taken to the end
  const char *label = "refine"; ///< for who waits
};

/// The search is `done` of these.
void tell_refined(const SearchOptions &options, const Effort &effort, std::size_t done) {
  constexpr std::size_t steps = 3;
  if (options.progress)
    options.progress(effort.label, done, steps);
}

/// Fixed attitudes that are worth a fit, of those that were judged best.
Result<std::vector<Turning>> find_places(const SearchModels &models,
                                         const std::vector<Turning> &judged, const Effort &effort,
                                         FoundErrors &errors, const SearchOptions &options) {
  tell_refined(options, effort, 0);
  auto out = inverse::cooled_places(models, judged, effort.times, options);
  bool has_changed = false;
  if (out.empty() || !errors.ask(out, has_changed))
    return tl::unexpected(stopped());
  return out;
}

/// Fits that have come to rest, best first.
Result<std::vector<TurningFit>> fit_places(const SearchModels &models,
                                           const std::vector<Turning> &places, const Effort &effort,
                                           FoundErrors &errors, const SearchOptions &options) {
  const std::size_t most = std::max(effort.kept, last_fits * times_of(models.last.curve()));
  tell_refined(options, effort, 1);
  const auto fits =
      inverse::first_fits(models.first, errors.likelihood(), places, most, options.threads);
  const bool has_parts = !models.first.parts().empty();
  const auto from = has_parts ? inverse::apart_first(inverse::turnings_of(fits, fits.size()), most)
                              : inverse::turnings_of(fits, most);
  bool has_changed = false;
  if (fits.empty() || !errors.ask(from, has_changed))
    return tl::unexpected(stopped());
  tell_refined(options, effort, 2);
  const std::size_t kept = has_parts ? from.size() : effort.kept; // dents crowd out no place
  return settled_fits(models.last, from, Freedom::Attitude, kept, errors, options);
}

/// Why nothing can be fitted, if that is so.
Result<void> needs_measurements(const CurveLikelihood &likelihood) {
  if (likelihood.measurements() == 0)
    return fail(ErrorCode::BadInput,
                "nothing was measured: no row has light with an error or above 0, nor q and u");
  return {};
}

/// Fits of all attitudes. Light that leaves many of them alike is asked for more of them.
Result<std::vector<TurningFit>> fits_of_all(const SearchModels &models,
                                            const std::vector<Turning> &judged, FoundErrors &errors,
                                            const SearchOptions &options) {
  constexpr std::size_t more = 4, most = 8; // of fits; of places
  const Effort usual{times_of(models.last.curve())};
  UMOV_ASSIGN(places, find_places(models, judged, usual, errors, options));
  UMOV_ASSIGN(fits, fit_places(models, places, usual, errors, options));
  if (!inverse::are_many(fits, inverse::span_of(models.last.curve())))
    return std::move(fits);
  const Effort larger{std::min(more * usual.times, most), more * last_fits, "refine more"};
  // Those that are known come first: what comes out is no worse.
  const auto known = inverse::turnings_of(fits, fits.size());
  UMOV_ASSIGN(more_places, find_places(models, judged, larger, errors, options));
  more_places.insert(more_places.begin(), known.begin(), known.end());
  return fit_places(models, more_places, larger, errors, options);
}

/// Chi-square of the best of some places after a few steps on few epochs, as of all epochs; where
/// that is more than `far`, after as many steps as a fit takes; less than 0 if it was stopped.
double chi2_after_few_steps(const CurveModel &model, const std::vector<Turning> &places,
                            const CurveLikelihood &likelihood, double far, unsigned threads) {
  const auto some = epochs_of_first_steps(model);
  const CurveLikelihood few(model.curve(), likelihood.errors(), some);
  const double all = static_cast<double>(likelihood.measurements()) /
                     static_cast<double>(std::max<std::size_t>(few.measurements(), 1));
  inverse::FitPlan plan = inverse::on_the_way(3, 1e-3, threads);
  auto fits = inverse::fit_turnings(model, few, places, some, plan);
  if (!fits.empty() && fits.front().at.chi2 * all > far) {
    // A search forgives up to a quarter of I, which can be a hundred times the errors: a good place
    // may be far off yet.
    constexpr std::size_t some_more = 30;
    plan.iterations = 12;
    fits = inverse::fit_turnings(model, few, inverse::turnings_of(fits, some_more), some, plan);
  }
  return fits.empty() ? -1 : fits.front().at.chi2 * all;
}

} // namespace

Result<PoseAnswer> search_pose(const SearchModels &models, const SearchOptions &options) {
  const auto &[model, first, quick] = models;
  FoundErrors errors(model, options);
  UMOV_TRY(needs_measurements(errors.likelihood()));
  UMOV_ASSIGN(judged, search_grid(quick, options));
  UMOV_ASSIGN(fits, fits_of_all(models, judged, errors, options));
  UMOV_ASSIGN(out, answer_of(model, first, errors.likelihood(), fits, Freedom::Attitude,
                             {judged, options.grid,
                              [&errors](double chi2) { return errors.explain(chi2); }},
                             options));
  out.share_of_so3 = inverse::share_of(out.set95);
  errors.tell(out);
  if (&quick != &first && &quick != &model)
    out.poses_lit += quick.poses_lit();
  out.unknowns = of_attitude;
  return out;
}

Result<double> least_chi2_at_rest(const SearchModels &models, const SearchOptions &options) {
  FoundErrors errors(models.last, options);
  UMOV_TRY(needs_measurements(errors.likelihood()));
  UMOV_ASSIGN(judged, search_grid(models.quick, options));
  const Effort effort{times_of(models.last.curve())};
  UMOV_ASSIGN(places, find_places(models, judged, effort, errors, options));
  // Ten standard deviations in each measurement: no further step makes an explanation of that.
  const double far = 100 * static_cast<double>(errors.likelihood().measurements());
  const double seen =
      chi2_after_few_steps(models.first, places, errors.likelihood(), far, options.threads);
  if (seen < 0)
    return tl::unexpected(stopped());
  if (seen > far)
    return seen;
  UMOV_ASSIGN(fits, fit_places(models, places, effort, errors, options));
  return fits.front().at.chi2;
}

namespace {

/// Starts of spins by quick light on few epochs, of those that may come to be the best.
std::vector<Turning> likely_spins(const CurveModel &first, const CurveErrors &errors,
                                  std::vector<Turning> starts, unsigned threads) {
  constexpr std::size_t least = 6, most = 24;
  constexpr double far = 60; // chi-square of few epochs
  const auto some = epochs_of_first_steps(first);
  const CurveLikelihood few(first.curve(), errors, some);
  const auto fits = inverse::fit_turnings(first, few, std::move(starts), some,
                                          {.freedom = Freedom::AttitudeAndRate,
                                           .iterations = 12,
                                           .cut_after = 4,
                                           .kept = most,
                                           .difference_rad = 1e-3,
                                           .threads = threads,
                                           .drops_hopeless = true,
                                           .tells_covariance = false});
  std::size_t count = std::min(fits.size(), least);
  while (count < std::min(fits.size(), most) && fits[count].at.chi2 < fits[0].at.chi2 + far)
    ++count;
  return inverse::turnings_of(fits, count);
}

} // namespace

Result<PoseAnswer> refine_spin(const CurveModel &model, const CurveModel &first,
                               std::span<const Turning> starts, const SearchOptions &options) {
  FoundErrors errors(model, options);
  bool has_changed = false;
  if (!errors.ask(starts, has_changed))
    return tl::unexpected(stopped());
  const auto likely = likely_spins(first, errors.likelihood().errors(),
                                   {starts.begin(), starts.end()}, options.threads);
  if (likely.empty() || !errors.ask(likely, has_changed))
    return tl::unexpected(stopped());
  UMOV_ASSIGN(fits,
              settled_fits(model, likely, Freedom::AttitudeAndRate, last_fits, errors, options));
  UMOV_ASSIGN(out, answer_of(model, model, errors.likelihood(), fits, Freedom::AttitudeAndRate, {},
                             options));
  errors.tell(out);
  out.unknowns = 7; // attitude, rate and scale
  return out;
}

bool is_in(std::span<const AttitudeBall> set, Quaternion attitude) {
  return std::ranges::any_of(set, [&](const AttitudeBall &ball) {
    const Quaternion q = ball.attitude;
    const double cos_half =
        std::abs(q.w * attitude.w + q.x * attitude.x + q.y * attitude.y + q.z * attitude.z);
    // 1 - x^2/2 is a cosine or less: most are too far to be asked how far.
    return 1 - cos_half < ball.radius_rad * ball.radius_rad / 8 + 1e-9 &&
           angle_between(q, attitude) <= ball.radius_rad;
  });
}

} // namespace umov
