#pragma once
// Private to the library: numbers whose errors are common, made independent.

#include <cstddef>
#include <span>
#include <vector>

namespace umov::algebra {

/// Numbers with a covariance C = diag(variance) + sum of e e^T over common effects e: L^-1 makes
/// them independent, L L^T = C. Good for many sets in turn: room is kept.
class Whitener {
public:
  /// `effects`: [number * terms + term], each times the standard deviation of what makes it.
  void reset(std::span<const double> variances, std::span<const double> effects, std::size_t terms);
  /// ln det C.
  [[nodiscard]] double log_determinant() const { return log_determinant_; }
  /// L^-1 of a column, in place.
  void whiten(std::span<double> column) const;

private:
  std::size_t size_ = 0;
  std::vector<double> root_; ///< L, row by row
  double log_determinant_ = 0;
};

} // namespace umov::algebra
