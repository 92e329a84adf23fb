#pragma once
// Which object of many made a curve, in whatever attitude: docs/theory/inverse.md, section 12.

#include <limits>
#include <optional>
#include <umov/inverse/pose_search.h>
#include <umov/inverse/signature.h>

namespace umov {

/// A signature that is lent, and its bands: band b of the curve is column[b] of it.
using LookAtCandidate =
    std::function<void(const Signature &signature, std::span<const std::size_t> column)>;

/// Objects to choose from.
struct Candidates {
  std::size_t count = 0;
  /// Lends signature k, from any thread: it is there as long as `look` runs, so that a library need
  /// not fit into memory.
  std::function<Result<void>(std::size_t k, const LookAtCandidate &look)> lend;
};

/// How a candidate was judged, each better than the one before.
enum class JudgedBy {
  Look,  ///< a quick look alone, which left it far behind
  Table, ///< a search through its signature, whose error between nodes is an error of the model
  Model  ///< its own light
};
/// "look", "table" or "model".
const char *name_of(JudgedBy by);

/// What a candidate's own light says: attitudes, and the errors they were found with.
struct OwnAnswer {
  PoseAnswer answer;
  double log_variance = 0; ///< CurveLikelihood::log_variance
};

/// How objects are told apart.
struct IdentifyOptions {
  SearchOptions search;           ///< errors, grid and samples of the searches; threads, seed
  double none_prior = 0.05;       ///< chance, before any data, that the object is none of them
  std::size_t look_grid = 14'000; ///< attitudes of the quick look
  std::size_t look_epochs = 16;   ///< and epochs
  std::size_t shortlist = 30;     ///< objects that are looked at again, with all of their light
  std::size_t finalists = 6;      ///< objects whose attitudes are searched for
  std::size_t own = 6;            ///< objects that are asked for their own light, at most
  std::size_t own_in_doubt = 12;  ///< the same as long as "none of them" leads
  /// The answer of the own light of candidate k; none where nobody has it. May be empty.
  std::function<Result<std::optional<OwnAnswer>>(std::size_t k)> own_light = {};
  /// Whether somebody has the own light of candidate k. Empty: of each, if there is any at all.
  std::function<bool(std::size_t k)> has_own_light = {};
};

/// One candidate.
struct CandidateFit {
  double probability = 0;
  double look = 0; ///< ln evidence of the quick look, among candidates alone
  /// ln evidence with the errors' own logarithms, comparable between candidates; NaN: not searched.
  double log_evidence = 0;
  /// ln of the largest likelihood through its signature, of those that were looked at again; else
  /// NaN.
  double peak = std::numeric_limits<double>::quiet_NaN();
  JudgedBy by = JudgedBy::Look;
  bool is_unasked = false; ///< one of IdentityAnswer::unasked
  PoseAnswer answer;       ///< empty where `by` is Look
};

/// Which object it was.
struct IdentityAnswer {
  std::vector<CandidateFit> candidates; ///< as they were given
  /// Of them, most probable first; those that are unasked may be before all that were searched.
  std::vector<std::size_t> order;
  double none = 1; ///< probability that it is none of them
  double none_log_evidence = 0;
  /// A candidate that was left out of the searches, and not asked for its own light since, may be
  /// as good as those that were not: it was hardly worse, or "none of them" leads, nobody has its
  /// light and its signature does not rule it out.
  bool is_cut = false;
  /// Where "none of them" leads: candidates whose own light could have been asked and was not, and
  /// that no signature rules out. They keep the odds to "none" that they had before the data.
  std::size_t unasked = 0;
  /// Candidates whose search in their own light did not come to rest (PoseAnswer::is_settled) and
  /// that are within e^30 of "none of them": a better fit may bring them there.
  std::size_t unsettled = 0;
};

/// Compares all candidates: a quick look at each, searches through the signatures of the best, and
/// through their own light where it is to be had, that of more of them as long as none of them
/// explains the curve. "None of them" stands for an object that is like
/// one of them but a quarter off in I, and for one whose light hardly changes (a constant, or a
/// diffuse sphere). BadInput for a curve without measurements; Interrupted; errors of `lend`.
Result<IdentityAnswer> identify(const ObservedCurve &curve, const Candidates &candidates,
                                const IdentifyOptions &options);

} // namespace umov
