#pragma once
// What neighbouring epochs of a series tell about one: local polynomials, as wide as the data
// allow.

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace umov {

/// Draws per replicate from which an estimate is believed: with fewer, rare bright ones are missed
/// and their absence is taken for accuracy.
inline constexpr std::size_t trusted_draws = 1024;

struct Smoothed {
  double mean = 0, half_width = 0; ///< 95 %
  double draws = 0;                ///< per replicate, of all places that were used
  std::size_t window = 0;          ///< the one that was taken; 0: the value alone
};

/// The windows around places along a line, and the weights that fit a parabola to what they hold:
/// they serve any number of series at the same places.
class LocalFits {
public:
  /// Each value is a mean of `draws`; places more than `reach` apart are never mixed.
  LocalFits(std::span<const double> place, std::span<const double> draws, double reach);

  /// The value at place k: the widest window whose estimate agrees with those of all narrower ones
  /// (the intersection of confidence intervals: Goldenshluger & Nemirovski 1997).
  /// value[replicate * places + place], of independent replicates; `widest`: no wider one than
  /// that.
  [[nodiscard]] Smoothed at(std::size_t k, std::span<const double> value,
                            std::size_t widest = no_limit) const;
  static constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

private:
  struct Window {
    std::size_t first = 0;
    std::vector<double> weight; ///< sum 1
    double draws = 0;
  };
  std::size_t places_;
  std::vector<std::vector<Window>> windows_; ///< per place, from narrow to wide
};

} // namespace umov
