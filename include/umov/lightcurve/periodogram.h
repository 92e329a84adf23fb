#pragma once
// How a light curve repeats: Lomb-Scargle of one pass in one band.

#include <array>
#include <span>
#include <vector>

namespace umov {

/// Power against period, shortest last. `trend` is the parabola in (t - first) / span that was
/// taken off.
struct Periodogram {
  std::vector<double> period_s;
  std::vector<double> power; ///< part of the variance that a sine of that period takes, in [0, 1]
  double best_s = 0;         ///< of the highest power, between the grid's frequencies
  std::array<double, 3> trend{};
};

/// Of magnitudes at times in order: less a parabola in time (range and phase angle change slowly),
/// with a floating mean (Zechmeister & Kuerster 2009, A&A 496, 577, Eq. 5). Periods from half the
/// span to twice the median step, or as far down as 3e8 products reach. Empty with fewer than 12
/// values, no span, or no variance.
Periodogram periodogram(std::span<const double> seconds, std::span<const double> magnitudes);

/// The same with at most `count` values: of neighbours the highest stays.
Periodogram with_fewer_values(const Periodogram &full, std::size_t count);

} // namespace umov
