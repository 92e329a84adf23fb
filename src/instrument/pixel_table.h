#pragma once
// Private: what pixels under one even light read, as a table to draw from.

#include <cstdint>
#include <optional>
#include <umov/instrument/detector.h>
#include <vector>

namespace umov {

/// Walker's table of the numbers that a pixel reads (Vose 1991, IEEE Trans. Software Eng. 17, 972):
/// Poisson electrons, reading noise and rounding in one draw of 32 bits, each number's probability
/// within 2^-32.
class PixelTable {
public:
  /// Nothing where a table does not serve: registers, counters, much light, pixels that may be
  /// full.
  static std::optional<PixelTable> make(const Detector &detector, double mean);
  /// A reading, of a random word.
  [[nodiscard]] int draw(std::uint32_t word) const {
    const std::uint32_t column = word >> shift_, rest = word << (32 - shift_);
    return first_ + static_cast<int>(rest < threshold_[column] ? column : alias_[column]);
  }

private:
  PixelTable() = default;
  void fill(std::vector<double> probability);
  int first_ = 0;
  unsigned shift_ = 31;
  std::vector<std::uint32_t> threshold_, alias_;
};

} // namespace umov
