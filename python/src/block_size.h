#pragma once
// Private: work of unknown length in pieces, between which somebody may stop it.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>

namespace umov::python {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// How many poses are lit together: as many as take a twentieth of a second, so that Ctrl-C need
/// not wait (masks of a new direction cost a thousand times what looking them up does).
class BlockSize {
public:
  /// `fixed`: always so many, where poses of a block share something.
  explicit BlockSize(std::optional<std::size_t> fixed = {})
      : is_fixed_(fixed.has_value()), size_(fixed.value_or(first)) {}
  [[nodiscard]] std::size_t size() const { return size_; }
  void learn(double seconds) {
    constexpr double wanted_s = 0.05;
    if (is_fixed_)
      return;
    if (seconds < wanted_s / 4)
      size_ = std::min(size_ * 4, most);
    else if (seconds > wanted_s)
      size_ = std::max(size_ / 2, least);
  }

private:
  static constexpr std::size_t first = 16, least = 4, most = 1u << 16;
  bool is_fixed_;
  std::size_t size_;
};

} // namespace umov::python
