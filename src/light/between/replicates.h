#pragma once
// Sixteen independent estimates of one number, and how far their mean may be off.

#include <cmath>
#include <cstddef>
#include <span>

namespace umov {

inline constexpr std::size_t replicates = 16;
/// Two-sided 95 % quantile of Student's t with 15 degrees of freedom.
inline constexpr double student_of_replicates = 2.131449545559323;

struct MeanOfReplicates {
  double mean = 0, deviation = 0; ///< deviation: standard error of the mean
};
inline MeanOfReplicates mean_of_replicates(std::span<const double> value) {
  const auto n = static_cast<double>(value.size());
  double mean = 0, squares = 0;
  for (const double x : value)
    mean += x / n;
  for (const double x : value)
    squares += (x - mean) * (x - mean);
  return {mean, std::sqrt(squares / (n * (n - 1)))};
}

} // namespace umov
