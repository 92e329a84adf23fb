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
};

/// Normal deviates of a seed: the same for the same index.
Eigen::VectorXd normal_vector(std::uint64_t seed, std::uint32_t stream, std::uint64_t index,
                              Eigen::Index size);

/// Importance sampling from broad tails around the modes (Student's t with 5 degrees of freedom),
/// which are then given the weights that their samples have. Empty if it was stopped.
Samples sample_modes(const CurveModel &model, const CurveLikelihood &likelihood,
                     std::vector<PoseMode> &modes, const SearchOptions &options);

/// Sequential Monte Carlo from all attitudes to the posterior (Del Moral, Doucet & Jasra 2006):
/// for a posterior of any shape that is not much narrower than its first particles lie apart.
Samples sample_all(const CurveModel &model, const CurveLikelihood &likelihood,
                   const SearchOptions &options);

/// Region of highest density with 95 % of the weight, as balls around its samples: each as large as
/// the distance to the fourth neighbour, but no larger than its mode is wide, or, without modes,
/// than three times the median ball (lone samples have their neighbours in other places).
std::vector<AttitudeBall> highest_density(const std::vector<PoseSample> &samples,
                                          std::span<const PoseMode> modes);
/// Share of SO(3) that a union of balls takes.
double share_of(std::span<const AttitudeBall> set);

} // namespace umov::inverse
