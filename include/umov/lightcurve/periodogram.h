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
  bool is_cut = false; ///< shorter periods were left out: 3e8 products did not reach them
};

/// Of magnitudes at times in order: less a parabola in time (range and phase angle change slowly),
/// with a floating mean (Zechmeister & Kuerster 2009, A&A 496, 577, Eq. 5). Periods from half the
/// span to twice the median step, or as far down as 3e8 products reach. Empty with fewer than 12
/// values, no span, or no variance.
Periodogram periodogram(std::span<const double> seconds, std::span<const double> magnitudes);

/// A period that stands out.
struct PeriodPeak {
  double period_s = 0, period_err_s = 0; ///< standard deviation, if what is left is noise
  double power = 0;                      ///< part of the variance that a sine takes
  double false_alarm = 1;                ///< how likely noise alone has a peak as high
};

/// The highest peaks of a periodogram of `count` values at `seconds`, the highest first, each its
/// own: what stands within 1.5 / span of a higher one is its shoulder. Errors: Montgomery &
/// O'Donoghue (1999); false alarms: Baluev (2008, MNRAS 385, 1279, Eqs. 5, 6).
std::vector<PeriodPeak> highest_peaks(const Periodogram &of, std::span<const double> seconds,
                                      std::size_t most);

/// What a peak says beside the higher ones.
struct PeakRelation {
  /// How it belongs to a higher one.
  enum class Kind {
    Own,      ///< a period by itself
    Multiple, ///< `ratio` times the period of peak `to`: a harmonic, or the turn of which it is a
              ///< part
    Sampling  ///< half of its height or more follows from peak `to` and the times of the values
  };
  Kind kind = Kind::Own;
  std::size_t to = 0; ///< index of a higher peak
  double ratio = 1;   ///< period over that of `to`: 1/4, 1/3, 1/2, 2/3, 3/2, 2, 3 or 4
};

/// Of peaks in order of their heights. A sine of one period has power at others too, by the
/// spectral window of its times (Roberts, Lehar & Dreher 1987, AJ 93, 968; VanderPlas 2018, ApJS
/// 236, 16, section 7): that is no second period. Multiples agree within half the width of a peak,
/// 1 / span.
std::vector<PeakRelation> relate_peaks(std::span<const PeriodPeak> peaks,
                                       std::span<const double> seconds);

/// The same with at most `count` values: of neighbours the highest stays.
Periodogram with_fewer_values(const Periodogram &full, std::size_t count);

} // namespace umov
