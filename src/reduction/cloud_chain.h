#pragma once
// Private to the library: a cloud that wanders, over the moments at which counts were taken.

#include "algebra/dense.h"

#include <cstdint>
#include <umov/reduction/sequence.h>

namespace umov {

/// When a count was taken.
struct CountMoment {
  double time_s = 0;
  std::int64_t exposure = 0; ///< counts of one see one cloud, as those of one time do
};

/// A cloud's deviations from its mean, of each moment of counts in whatever order: an
/// Ornstein-Uhlenbeck process, the inverse of whose covariance is a band of three.
class CloudChain {
public:
  CloudChain() = default;
  /// No moments where the cloud has no standard deviation.
  CloudChain(std::span<const CountMoment> counts, const CloudPrior &prior);

  [[nodiscard]] bool empty() const { return moment_.empty(); }
  [[nodiscard]] Eigen::Index moments() const { return diagonal_.size(); }
  /// Of a count.
  [[nodiscard]] Eigen::Index moment(std::size_t count) const { return moment_[count]; }
  /// (K^-1 + W)^-1 m, K the covariance of the moments and W a diagonal.
  [[nodiscard]] algebra::MatrixXd solve(const algebra::VectorXd &weights,
                                        algebra::MatrixXd m) const;
  /// Of K^-1 + W, and of K: the sum of both logarithms.
  [[nodiscard]] double log_determinant(const algebra::VectorXd &weights) const;

private:
  [[nodiscard]] algebra::VectorXd pivots(const algebra::VectorXd &weights) const;
  std::vector<Eigen::Index> moment_; ///< of each count
  algebra::VectorXd diagonal_;       ///< of K^-1
  algebra::VectorXd before_;         ///< of the same: of a moment with the one before it
};

} // namespace umov
