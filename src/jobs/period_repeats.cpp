// After what time light repeats, and what spin that may be.

#include "jobs/period_search.h"

#include <algorithm>
#include <fmt/format.h>

namespace umov::jobs {

Repetition repetition_of(const Stretch &stretch, double peak_s, double false_alarm) {
  constexpr double few = 0.01; // whatever weak peaks are asked for
  Repetition out;
  out.peak_s = out.period_s = peak_s;
  out.at_period = alternation(stretch.seconds, stretch.magnitudes, peak_s);
  for (int k = 0; k < 2 && out.at_period.false_alarm < std::min(false_alarm, few); ++k) {
    out.last_doubled = out.at_period;
    out.period_s *= 2;
    out.at_period = alternation(stretch.seconds, stretch.magnitudes, out.period_s);
  }
  return out;
}

namespace {

/// What is known of turns twice as long, as a sentence.
std::string doubt(const Repetition &r) {
  if (!r.at_period.is_told)
    return fmt::format("{:.2g} turns are too few to tell whether every second one differs",
                       r.at_period.turns);
  return fmt::format("Turns of {:.4g} s differ by {:.2g} mag, as noise makes them with a chance of "
                     "{:.2g}: nothing says that it is longer",
                     r.period_s, r.at_period.difference, r.at_period.false_alarm);
}

} // namespace

std::string describe(const Repetition &r, const std::string &where) {
  const double p = r.period_s;
  if (p > r.peak_s)
    return fmt::format(
        "light repeats every {:.4g} s{}, {} the highest peak, {:.4g} s: every second turn of "
        "{:.4g} "
        "s differs by {:.2g} mag, which noise makes with a chance of {:.2g}. The spin is {:.4g} s, "
        "or twice that, {:.4g} s, if two sides are alike even so; each synodic. {}",
        p, where, p > 3 * r.peak_s ? "four times" : "twice", r.peak_s, p / 2,
        r.last_doubled.difference, r.last_doubled.false_alarm, p, 2 * p, doubt(r));
  return fmt::format(
      "light repeats every {:.4g} s{}: the spin is {:.4g} s, or twice that, {:.4g} s, if two "
      "sides are alike, or, of a tumbling body, half of it, {:.4g} s; each synodic. {}. Two "
      "sides that are alike do not show in brightness: fold at each, or umov invert spin",
      p, where, p, 2 * p, p / 2, doubt(r));
}

} // namespace umov::jobs
