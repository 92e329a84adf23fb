#pragma once
// Private: sets of attitudes as balls around samples.

#include <span>
#include <umov/inverse/pose_search.h>
#include <vector>

namespace umov::inverse {

/// Distance [rad] of every sample to its `rank`-th neighbour that is not the same attitude.
std::vector<double> neighbour_distances(const std::vector<PoseSample> &draws, std::size_t rank,
                                        unsigned threads);

/// Some attitudes.
struct AttitudeSet {
  std::vector<AttitudeBall> balls; ///< it is their union
  double growth = 1;               ///< what they were widened by
  double level = 0;                ///< -2 ln likelihood of the least likely sample among them
};
/// What balls are widened by at most.
inline constexpr double most_growth = 3;
/// Region of highest density with 95 % of the weight, as balls around its samples: each as large as
/// the distance to the fourth neighbour, but no larger than its mode is wide, or, without modes,
/// than three times the median ball (lone samples have their neighbours in other places). All are
/// widened, up to `most_growth`, until balls around other samples hold 95 % of the weight: what a
/// set leaves out of samples that it was not made of it leaves out of the posterior. `runs`:
/// samples of one know of each other, and do not count as others; empty: each is one by itself. One
/// run alone stays as it is.
AttitudeSet highest_density(const std::vector<PoseSample> &samples, std::span<const PoseMode> modes,
                            std::span<const std::size_t> runs = {});
/// Share of SO(3) that a union of balls takes.
double share_of(std::span<const AttitudeBall> set);

} // namespace umov::inverse
