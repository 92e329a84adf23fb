#include <umov/inverse/identify.h>

#include "inverse/identity_evidence.h"
#include "inverse/quick_look.h"
#include "inverse/some_epochs.h"
#include "inverse/turning_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <umov/core/parallel.h>

namespace umov {

using inverse::least_log;
using inverse::log_of;
using inverse::log_sum;
using inverse::mean_evidence;
using inverse::of_kin;
using inverse::QuickLook;

namespace {

constexpr double table_doubt = 30;     // e-folds that a table is believed against
constexpr double hardly = 3;           // e-folds by which one that is left out is hardly worse
constexpr std::size_t again_most = 60; // epochs of the second look

/// The same search where colours may be others.
SearchOptions recoloured_search(SearchOptions options) {
  options.errors = inverse::of_recoloured(options.errors);
  return options;
}

/// One question on its way to its answer.
class Identification {
public:
  Identification(const ObservedCurve &curve, const Candidates &candidates,
                 const IdentifyOptions &options)
      : curve_(curve), from_(candidates), options_(options),
        look_(curve, options.search.errors, options.look_grid, options.look_epochs) {
    out_.candidates.resize(candidates.count);
    is_dark_.resize(candidates.count);
  }

  Result<IdentityAnswer> answer();

private:
  Result<void> look_at_all();
  Result<void> rank_again();
  Result<void> add_kin(std::size_t k);
  Result<void> search(std::size_t k);
  [[nodiscard]] bool has_own_light(std::size_t k) const;
  /// False where nobody has its light.
  Result<bool> ask(std::size_t k);
  Result<void> ask_own_light();
  Result<void> ask_before_none();
  /// E-folds that rule an object out by its table. Its errors are common to neighbouring epochs, so
  /// that the rows weigh less, as in `weigh`.
  [[nodiscard]] double doubt() const {
    return table_doubt / inverse::independent_share(curve_, cells_);
  }
  [[nodiscard]] double mark_of(std::size_t k) const;
  [[nodiscard]] bool is_ruled_out(std::size_t k) const;
  [[nodiscard]] std::vector<std::size_t> in_doubt() const;
  [[nodiscard]] bool is_cut() const;
  [[nodiscard]] std::size_t unsettled() const;
  [[nodiscard]] bool none_leads() const;
  void judge_none();
  void weigh();
  /// ln of the chance of each candidate before any data.
  [[nodiscard]] double log_each() const {
    return log_of((1 - options_.none_prior) / static_cast<double>(from_.count));
  }
  void cut(std::vector<std::size_t> &ranked, std::size_t most, const std::vector<double> &by);
  [[nodiscard]] std::vector<Turning> best_of(const Signature &signature,
                                             std::span<const std::size_t> column) const;
  void tell(const char *what, std::size_t done, std::size_t total) const {
    if (options_.search.progress)
      options_.search.progress(what, done, total);
  }

  const ObservedCurve &curve_;
  const Candidates &from_;
  const IdentifyOptions &options_;
  QuickLook look_;
  std::vector<std::size_t> left_;
  std::vector<std::size_t> hardly_worse_; ///< than the best, and left out of the searches
  std::size_t cells_ = 20;                ///< a side, of the last signature that was searched
  std::vector<double> kin_;   ///< ln evidence of something like a candidate, of those judged
  std::size_t asked_ = 0;     ///< for their own light
  std::vector<bool> is_dark_; ///< nobody had its light when it was asked
  IdentityAnswer out_;
};

/// Leaves the `most` best, and remembers those that go though they were hardly worse.
void Identification::cut(std::vector<std::size_t> &ranked, std::size_t most,
                         const std::vector<double> &by) {
  std::ranges::stable_sort(ranked, [&](std::size_t a, std::size_t b) { return by[a] > by[b]; });
  for (std::size_t j = most; j < ranked.size(); ++j)
    if (by[ranked[j]] > by[ranked.front()] - hardly)
      hardly_worse_.push_back(ranked[j]);
  ranked.resize(std::min(most, ranked.size()));
}

Result<void> Identification::look_at_all() {
  tell("look", 0, from_.count);
  std::vector<Result<void>> done(from_.count);
  constexpr std::size_t at_once = 64; // between two words of progress
  for (std::size_t begin = 0; begin < from_.count; begin += at_once) {
    const std::size_t count = std::min(at_once, from_.count - begin);
    parallel_for(count, options_.search.threads, [&](std::size_t j) {
      const std::size_t k = begin + j;
      done[k] = from_.lend(k, [&](const Signature &s, std::span<const std::size_t> column) {
        out_.candidates[k].look = QuickLook::log_evidence(look_.look(s, column));
      });
    });
    for (std::size_t k = begin; k < begin + count; ++k)
      UMOV_TRY(done[k]);
    tell("look", begin + count, from_.count);
  }
  std::vector<double> by;
  by.reserve(from_.count);
  for (const CandidateFit &one : out_.candidates)
    by.push_back(one.look);
  left_.resize(from_.count);
  std::iota(left_.begin(), left_.end(), std::size_t{0});
  cut(left_, options_.shortlist, by);
  return {};
}

std::vector<Turning> Identification::best_of(const Signature &signature,
                                             std::span<const std::size_t> column) const {
  constexpr std::size_t part = 10; // of the grid that is looked at again
  std::vector<Turning> out;
  const auto chi2 = look_.look(signature, column);
  const auto best = QuickLook::best(chi2, std::max<std::size_t>(1, chi2.size() / part));
  out.reserve(best.size());
  for (const std::size_t k : best)
    out.push_back({look_.attitude(k), {}});
  return out;
}

/// The best of the look once more, with light between the nodes and more epochs, and fitted: on the
/// grid, which is 10 deg apart, an object of narrow glints is worse than one that has none.
Result<void> Identification::rank_again() {
  const auto epochs = inverse::some_epochs(curve_.epochs.size(), again_most);
  std::vector<double> by(from_.count, least_log);
  for (std::size_t j = 0; j < left_.size(); ++j) {
    tell("look again", j, left_.size());
    Result<double> found = 0.0;
    UMOV_TRY(from_.lend(left_[j], [&](const Signature &s, std::span<const std::size_t> column) {
      const CurveModel model(curve_, lighting_of(s, options_.search.threads),
                             {column.begin(), column.end()});
      found = inverse::table_peak(model, options_.search.errors, s.error, best_of(s, column),
                                  epochs, options_.search.threads);
    }));
    UMOV_TRY(found);
    by[left_[j]] = out_.candidates[left_[j]].peak = *found;
  }
  cut(left_, options_.finalists, by);
  return {};
}

/// The evidence of something like a candidate.
Result<void> Identification::add_kin(std::size_t k) {
  const unsigned threads = options_.search.threads;
  Result<double> recoloured = 0.0, like = 0.0;
  UMOV_TRY(from_.lend(k, [&](const Signature &s, std::span<const std::size_t> column) {
    const CurveModel model(curve_, lighting_of(s, threads), {column.begin(), column.end()});
    like = mean_evidence(model, CurveLikelihood(curve_, of_kin(options_.search.errors)),
                         best_of(s, column), {}, options_.look_grid, threads);
    PoseAnswer unused;
    recoloured =
        inverse::table_evidence(model, recoloured_search(options_.search), s.error, unused);
  }));
  UMOV_TRY(like);
  UMOV_TRY(recoloured);
  kin_.push_back(log_sum(*like, *recoloured) - std::log(2.0));
  return {};
}

/// Attitudes of one candidate through its signature.
Result<void> Identification::search(std::size_t k) {
  CandidateFit &fit = out_.candidates[k];
  Result<double> own = 0.0;
  UMOV_TRY(from_.lend(k, [&](const Signature &s, std::span<const std::size_t> column) {
    const CurveModel model(curve_, lighting_of(s, options_.search.threads),
                           {column.begin(), column.end()});
    cells_ = s.cells;
    own = inverse::table_evidence(model, options_.search, s.error, fit.answer);
  }));
  UMOV_TRY(own);
  fit.by = JudgedBy::Table;
  fit.log_evidence = *own;
  return add_kin(k);
}

bool Identification::has_own_light(std::size_t k) const {
  return options_.own_light && !is_dark_[k] &&
         (!options_.has_own_light || options_.has_own_light(k));
}

Result<bool> Identification::ask(std::size_t k) {
  if (!has_own_light(k))
    return false;
  tell("own light", asked_, std::max(asked_ + 1, options_.own));
  UMOV_ASSIGN(own, options_.own_light(k));
  is_dark_[k] = !own;
  if (!own)
    return false;
  ++asked_;
  CandidateFit &fit = out_.candidates[k];
  fit.by = JudgedBy::Model;
  fit.answer = std::move(own->answer);
  fit.log_evidence =
      fit.answer.log_evidence - own->log_variance / 2 + inverse::log_misfit(fit.answer);
  return true;
}

/// Those that the tables hardly tell apart are asked, and whoever leads then.
Result<void> Identification::ask_own_light() {
  const auto rank = [&](std::size_t k) { return out_.candidates[k].log_evidence; };
  std::ranges::stable_sort(left_, std::ranges::greater{}, rank);
  const double line = left_.empty() ? 0 : rank(left_.front()) - doubt();
  for (const std::size_t next : std::vector<std::size_t>(left_)) {
    const std::size_t best = *std::ranges::max_element(left_, {}, rank);
    if (asked_ >= options_.own || (rank(next) < line && next != best))
      return {};
    UMOV_TRY(ask(next));
  }
  return {};
}

/// What is known of a candidate that has not been asked: NaN of one that the look left behind.
double Identification::mark_of(std::size_t k) const {
  const CandidateFit &fit = out_.candidates[k];
  return fit.by == JudgedBy::Table ? fit.log_evidence : fit.peak;
}

/// Its table says that it is not the one. A peak of few epochs is of fewer data than "none" is.
bool Identification::is_ruled_out(std::size_t k) const {
  const bool has_all = curve_.epochs.size() <= again_most;
  return (has_all || out_.candidates[k].by == JudgedBy::Table) &&
         mark_of(k) < out_.none_log_evidence - doubt();
}

/// Candidates whose own light can still be asked and that no signature rules out, best first.
std::vector<std::size_t> Identification::in_doubt() const {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < from_.count; ++k)
    if (out_.candidates[k].by != JudgedBy::Model && has_own_light(k) && !is_ruled_out(k))
      out.push_back(k);
  std::ranges::stable_sort(out, [&](std::size_t a, std::size_t b) {
    const bool has_a = !std::isnan(mark_of(a)), has_b = !std::isnan(mark_of(b));
    if (!has_a || !has_b)
      return has_a == has_b ? out_.candidates[a].look > out_.candidates[b].look : has_a;
    return mark_of(a) > mark_of(b);
  });
  return out;
}

/// One that was left out, and not asked since, may be the one: it was hardly worse, or "none" leads
/// and its table, looked at again, does not rule it out.
bool Identification::is_cut() const {
  const bool leads = none_leads();
  for (std::size_t k = 0; k < from_.count; ++k) {
    const CandidateFit &fit = out_.candidates[k];
    if (fit.by == JudgedBy::Look && !has_own_light(k) && leads && !std::isnan(fit.peak) &&
        !is_ruled_out(k))
      return true;
  }
  return std::ranges::any_of(
      hardly_worse_, [&](std::size_t k) { return out_.candidates[k].by != JudgedBy::Model; });
}

/// Candidates whose own search did not come to rest, and that a better fit may bring to "none".
std::size_t Identification::unsettled() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(out_.candidates, [&](const CandidateFit &fit) {
        return fit.by == JudgedBy::Model && !fit.answer.is_settled &&
               fit.log_evidence > out_.none_log_evidence - table_doubt;
      }));
}

bool Identification::none_leads() const {
  double best = least_log;
  for (const std::size_t k : left_)
    best = std::max(best, out_.candidates[k].log_evidence);
  return log_of(options_.none_prior) + out_.none_log_evidence > log_each() + best;
}

/// "None of these" is what is left when all others have been asked.
Result<void> Identification::ask_before_none() {
  for (const std::size_t next : in_doubt()) {
    if (!none_leads() || asked_ >= options_.own_in_doubt)
      break;
    UMOV_ASSIGN(has_answered, ask(next));
    if (!has_answered || std::ranges::find(left_, next) != left_.end())
      continue;
    left_.push_back(next);
    UMOV_TRY(add_kin(next));
    judge_none();
  }
  if (!none_leads())
    return {};
  for (const std::size_t k : in_doubt()) {
    out_.candidates[k].is_unasked = true;
    ++out_.unasked;
  }
  return {};
}

void Identification::judge_none() {
  double kin = least_log;
  for (const double one : kin_)
    kin = log_sum(kin, one - std::log(static_cast<double>(from_.count)));
  out_.none_log_evidence =
      log_sum(kin, inverse::featureless(curve_, options_.search.errors)) - std::log(2.0);
}

void Identification::weigh() {
  // Tables alone: their errors are common to neighbouring epochs, so that the rows weigh less.
  const bool has_models = std::ranges::any_of(
      out_.candidates, [](const CandidateFit &fit) { return fit.by == JudgedBy::Model; });
  const double share = has_models ? 1 : inverse::independent_share(curve_, cells_);
  out_.none_log_evidence *= share;
  for (CandidateFit &fit : out_.candidates)
    fit.log_evidence *= share;
  double all = log_of(options_.none_prior) + out_.none_log_evidence;
  for (CandidateFit &fit : out_.candidates)
    if (fit.by == JudgedBy::Look)
      fit.log_evidence = std::nan("");
  const auto evidence_of = [&](std::size_t k) {
    const CandidateFit &fit = out_.candidates[k];
    return fit.is_unasked ? out_.none_log_evidence : fit.log_evidence;
  };
  std::vector<std::size_t> judged;
  for (std::size_t k = 0; k < from_.count; ++k)
    if (out_.candidates[k].is_unasked || out_.candidates[k].by != JudgedBy::Look)
      judged.push_back(k);
  for (const std::size_t k : judged)
    all = log_sum(all, log_each() + evidence_of(k));
  for (const std::size_t k : judged)
    out_.candidates[k].probability = std::exp(log_each() + evidence_of(k) - all);
  out_.none = std::exp(log_of(options_.none_prior) + out_.none_log_evidence - all);
  out_.order.resize(from_.count);
  std::iota(out_.order.begin(), out_.order.end(), std::size_t{0});
  std::ranges::stable_sort(out_.order, [&](std::size_t a, std::size_t b) {
    const CandidateFit &x = out_.candidates[a], &y = out_.candidates[b];
    if (x.probability != y.probability)
      return x.probability > y.probability;
    const bool is_x = x.by != JudgedBy::Look, is_y = y.by != JudgedBy::Look;
    if (is_x != is_y)
      return is_x;
    return is_x ? x.log_evidence > y.log_evidence : x.look > y.look;
  });
}

Result<IdentityAnswer> Identification::answer() {
  UMOV_TRY(look_at_all());
  UMOV_TRY(rank_again());
  for (std::size_t j = 0; j < left_.size(); ++j) {
    tell("search", j, left_.size());
    UMOV_TRY(search(left_[j]));
  }
  UMOV_TRY(ask_own_light());
  judge_none();
  UMOV_TRY(ask_before_none());
  out_.is_cut = is_cut();
  out_.unsettled = unsettled();
  weigh();
  return std::move(out_);
}

} // namespace

const char *name_of(JudgedBy by) {
  switch (by) {
  case JudgedBy::Table:
    return "table";
  case JudgedBy::Model:
    return "model";
  case JudgedBy::Look:
    break;
  }
  return "look";
}

Result<IdentityAnswer> identify(const ObservedCurve &curve, const Candidates &candidates,
                                const IdentifyOptions &options) {
  if (CurveLikelihood(curve, options.search.errors).measurements() == 0)
    return fail(ErrorCode::BadInput,
                "nothing was measured: no row has light with an error or above 0, nor q and u");
  if (candidates.count == 0)
    return fail(ErrorCode::BadInput, "there is no object to choose from");
  return Identification(curve, candidates, options).answer();
}

} // namespace umov
