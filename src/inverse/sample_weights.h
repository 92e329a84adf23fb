#pragma once
// Private: weights of samples.

#include <umov/inverse/pose_search.h>
#include <vector>

namespace umov::inverse {

inline constexpr double no_weight = -1e300; ///< ln of it: of what is no number

/// Weights from logarithms, and the logarithm of what they add up to. What has none (NaN) weighs
/// nothing.
double normalize(std::vector<PoseSample> &draws, std::vector<double> log_weight);
/// Size of an unweighted sample as good as this one.
double effective_size(const std::vector<PoseSample> &draws);
/// Weights, from their logarithms, to a power; of the highest 1.
std::vector<double> to_power(const std::vector<double> &log_weights, double power);
/// How many samples weights are worth.
double worth(const std::vector<double> &weights);
/// The largest power, `most` at most, that leaves weights worth `wanted` samples; 0 if none does.
double power_worth(const std::vector<double> &log_weights, double most, double wanted);

} // namespace umov::inverse
