#pragma once
// Private: from fits to samples, weights and sets.

#include "inverse/turning_fit.h"

#include <memory>
#include <umov/inverse/pose_search.h>

namespace umov::inverse {

/// Samples of a posterior with their evidence.
struct Samples {
  std::vector<PoseSample> draws;
  double log_evidence = 0;
  double evidences_apart = 0; ///< of its runs: the difference of the largest and the least, in ln
  double effective = 0;       ///< size of an unweighted sample as good as this one
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

/// Broad tails around modes, as a density of attitudes to begin with.
class AroundModes {
public:
  /// Of `count` draws, or a few more.
  AroundModes(const std::vector<PoseMode> &modes, std::size_t count);
  ~AroundModes();
  AroundModes(const AroundModes &) = delete;
  AroundModes &operator=(const AroundModes &) = delete;
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::vector<Turning> drawn(std::uint64_t seed, std::uint32_t stream) const;
  /// In parts of that in which all attitudes are alike.
  [[nodiscard]] double density(const Turning &at) const;

private:
  struct Tails;
  std::unique_ptr<const Tails> tails_;
  std::size_t count_ = 0;
};

/// Sequential Monte Carlo from all attitudes, and more of those around the modes that are known, to
/// the posterior (Del Moral, Doucet & Jasra 2006): for a posterior of any shape. Two runs, each
/// from a grid of its own, and of curves of fewer than 40 epochs up to two more where these do not
/// agree, of many more particles if it is in their evidence: what one run lost all of its particles
/// have lost. They are followed by `quick` light, and by that of `last` at the end.
Samples sample_all(const CurveModel &quick, const CurveModel &last,
                   const CurveLikelihood &likelihood, const std::vector<PoseMode> &modes,
                   const SearchOptions &options);

} // namespace umov::inverse
