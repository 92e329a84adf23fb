#pragma once
// Whether light repeats after a period, or only after twice that.

#include <span>

namespace umov {

/// How much every second turn of a period differs from the others.
struct Alternation {
  bool is_told = false;   ///< six turns and twenty values are there: fewer tell nothing
  double false_alarm = 1; ///< chance that noise makes turns differ as much
  double difference = 0;  ///< root mean square of one turn less the next, of the sines found [mag]
  double turns = 0;       ///< in the span
};

/// Of magnitudes at times in order, less a parabola and eight harmonics of 1 / period that grow or
/// fade evenly: the power of the first three odd harmonics of half its frequency, each beside that
/// of up to twenty frequencies 1.5, 2.5, ... / span away, which no repetition has. So noise may be
/// red. The chance is that of Fisher's F, the three together by his sum of logarithms.
Alternation alternation(std::span<const double> seconds, std::span<const double> magnitudes,
                        double period_s);

} // namespace umov
