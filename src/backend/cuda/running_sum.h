#pragma once
// A sum in single precision that loses nothing on the way: what would be rounded off is kept beside
// it. A million facets added up one by one would else be off by 1e-4, and the second word costs six
// additions where a double of a desktop's card costs sixty-four times as much.

#include "kernel/qualifier.h"

namespace umov::backend {

/// Kahan and Babuska's sum as Neumaier (1974) has it.
class RunningSum {
public:
  RunningSum() = default;
  UMOV_KERNEL RunningSum(float x) : sum_(x) {}
  UMOV_KERNEL RunningSum &operator+=(float x) {
    const float next = sum_ + x;
    const bool is_larger = (sum_ < 0 ? -sum_ : sum_) >= (x < 0 ? -x : x);
    rest_ += is_larger ? (sum_ - next) + x : (x - next) + sum_;
    sum_ = next;
    return *this;
  }
  UMOV_KERNEL friend RunningSum operator*(RunningSum a, RunningSum b) { return a.sum_ * b.sum_; }
  /// Both words as one.
  [[nodiscard]] UMOV_KERNEL float rounded() const { return sum_ + rest_; }
  /// On the host: both words.
  [[nodiscard]] double value() const {
    return static_cast<double>(sum_) + static_cast<double>(rest_);
  }

private:
  float sum_ = 0, rest_ = 0;
};

} // namespace umov::backend
