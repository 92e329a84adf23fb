#pragma once
// Private: from fits to samples, weights and sets.

#include "inverse/turning_fit.h"

#include <umov/inverse/pose_search.h>

namespace umov::inverse {

/// Samples of a posterior with their evidence.
struct Samples {
  std::vector<PoseSample> draws;
  double log_evidence = 0;
  double effective = 0; ///< size of an unweighted sample as good as this one
  /// Of each draw, the run that it came of, which is alike in those of one; empty: each draw is one
  /// by itself.
  std::vector<std::size_t> runs;
};

/// Normal deviates of a seed: the same for the same index.
Eigen::VectorXd normal_vector(std::uint64_t seed, std::uint32_t stream, std::uint64_t index,
                              Eigen::Index size);

/// Importance sampling from broad tails around the modes (Student's t with 5 degrees of freedom),
/// which are then given the weights that their samples have. Empty if it was stopped.
Samples sample_modes(const CurveModel &model, const CurveLikelihood &likelihood,
                     std::vector<PoseMode> &modes, const SearchOptions &options);

/// Sequential Monte Carlo from all attitudes to the posterior (Del Moral, Doucet & Jasra 2006):
/// for a posterior of any shape that is not much narrower than its first particles lie apart. Two
/// runs, each from a grid of its own, and of curves of fewer than 40 epochs up to four until the
/// set of all leaves little of each run outside: what one run lost all of its particles have lost.
/// They are followed by `quick` light and weighted by that of `last`.
Samples sample_all(const CurveModel &quick, const CurveModel &last,
                   const CurveLikelihood &likelihood, const SearchOptions &options);
/// Particles with what they lost of peaks: draws around these that are as likely as the particles'
/// set but lie out of it count as they do among the peaks' own.
void add_lost(const Samples &peaks, Samples &particles);

} // namespace umov::inverse
