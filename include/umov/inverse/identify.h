#pragma once
// Which object of a library gave a curve, whatever its attitude: docs/theory/inverse.md,
// section 10.

#include <umov/inverse/pose_search.h>
#include <umov/inverse/signature.h>

namespace umov {

/// How a library is searched.
struct IdentifyOptions {
  SearchOptions search;           ///< of the finalists; `grid` attitudes each
  std::size_t attitudes = 12'000; ///< that rank all objects, at 8 epochs
  std::size_t finalists = 6;      ///< that are fitted
  double none_prior = 0.05;       ///< probability before that it is none of them
};

/// An object of the library, as far as it was looked at.
struct IdentityCandidate {
  std::size_t which = 0;    ///< of the library
  double rank_score = 0;    ///< of the first look: chi-square per number, robust
  bool is_finalist = false; ///< the rest is of those alone
  double probability = 0;   ///< of those that are none: 0
  double log_evidence = 0;
  double chi2 = 0;
  std::size_t measurements = 0;
  bool is_broad = false; ///< it explains the curve in a wide region of attitudes
  Quaternion attitude;   ///< heaviest
};

/// What a curve says about the object.
struct IdentityAnswer {
  std::vector<IdentityCandidate> candidates; ///< finalists, most probable first, then by rank
  double none = 0;                           ///< probability of none of them
  double none_log_evidence = 0;
};

/// All objects at a first look, which refines their best attitudes roughly; the best by their
/// evidence over all attitudes, beside that of an object akin to one of them but another. All
/// signatures have the same cells and bands. Interrupted if the light stopped; BadInput for a curve
/// without brightness, Usage for an empty library.
Result<IdentityAnswer> identify(const ObservedCurve &curve, const std::vector<std::size_t> &column,
                                std::span<const Signature> library, const IdentifyOptions &options);

} // namespace umov
