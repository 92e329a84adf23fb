// The search for passes: altitude on a coarse grid, its maxima and crossings refined.

#include "orbit/pass_search.h"

#include <algorithm>
#include <cmath>
#include <umov/core/golden_section.h>
#include <umov/core/quantity.h>

namespace umov {
namespace {

using passes::crossing;
using passes::Stretch;

constexpr double crossing_tolerance_s = 1e-3;
constexpr double top_tolerance_s = 0.05; // the altitude is flat there

bool is_set(const std::atomic<bool> *cancel) {
  return cancel != nullptr && cancel->load(std::memory_order_relaxed);
}

/// Altitude over a site, at seconds after a start.
class Altitude {
public:
  Altitude(const Trajectory &orbit, const Site &site, Epoch<Utc> start)
      : orbit_(orbit), site_(site), start_(start) {}

  [[nodiscard]] Epoch<Utc> time(double seconds) const { return plus_seconds(start_, seconds); }
  [[nodiscard]] bool is_there(double seconds) const { return orbit_.at(time(seconds)).has_value(); }
  [[nodiscard]] Error error(double seconds) const { return orbit_.at(time(seconds)).error(); }
  /// [rad]; below every horizon where the orbit cannot be had.
  double operator()(double seconds) const {
    const auto state = orbit_.at(time(seconds));
    return state ? topocentric_altitude(*state, time(seconds), site_).radians() : -pi;
  }
  /// The same at many times; shorter where the orbit ends or the search is cancelled.
  [[nodiscard]] std::vector<double> operator()(const std::vector<double> &seconds,
                                               const std::atomic<bool> *cancel) const {
    constexpr std::size_t block_max = 4096; // states of a century's times need not be held at once
    std::vector<double> out;
    out.reserve(seconds.size());
    std::vector<Epoch<Utc>> times;
    std::vector<OrbitState> states(std::min(block_max, seconds.size()));
    while (out.size() < seconds.size() && !is_set(cancel)) {
      const std::size_t block = std::min(block_max, seconds.size() - out.size());
      times.clear();
      for (std::size_t k = 0; k < block; ++k)
        times.push_back(time(seconds[out.size() + k]));
      const std::size_t known = orbit_.at(times, std::span(states).first(block));
      for (std::size_t k = 0; k < known; ++k)
        out.push_back(topocentric_altitude(states[k], times[k], site_).radians());
      if (known < block)
        break;
    }
    return out;
  }

private:
  const Trajectory &orbit_;
  const Site &site_;
  Epoch<Utc> start_;
};

using Function = std::function<double(double)>;

/// The largest f between a and b, where it has one maximum, by golden section.
double maximum(const Function &f, double a, double b, double tolerance = top_tolerance_s) {
  return golden_minimum([&f](double t) { return -f(t); }, a, b, tolerance);
}

/// Times on which the altitude has no more than one maximum between neighbours' neighbours.
std::vector<double> coarse_times(const Trajectory &orbit, double span_s) {
  const auto count = static_cast<std::size_t>(std::ceil(span_s / orbit.search_step_s())) + 1;
  std::vector<double> out;
  for (std::size_t k = 0; k < count; ++k)
    out.push_back(span_s * static_cast<double>(k) /
                  static_cast<double>(std::max<std::size_t>(count - 1, 1)));
  return out;
}

/// Altitudes less the wanted one, with the tops of passes between the grid's times put in.
struct Samples {
  std::vector<double> time, above; ///< [s], [rad]
};

/// Where an orbit begins or ends to be there, between one time that has it and one that has not:
/// the time on the side that has it.
double edge(const Altitude &altitude, double good, double bad) {
  while (std::abs(bad - good) > crossing_tolerance_s) {
    const double middle = 0.5 * (good + bad);
    (altitude.is_there(middle) ? good : bad) = middle;
  }
  return good;
}

/// The grid from its index `first`, where the orbit is there, to where it no longer is.
Samples sample(const Altitude &altitude, const std::vector<double> &grid, std::size_t first,
               const std::atomic<bool> *cancel) {
  Samples out;
  out.time.assign(grid.begin() + static_cast<std::ptrdiff_t>(first), grid.end());
  out.above = altitude(out.time, cancel);
  const std::size_t count = out.above.size();
  if (count == 0) // cancelled before its first block
    return {};
  const auto put = [&](double time, bool is_front) {
    out.time.insert(is_front ? out.time.begin() : out.time.end(), time);
    out.above.insert(is_front ? out.above.begin() : out.above.end(), altitude(time));
  };
  out.time.resize(count);
  if (const std::size_t behind = first + count; behind < grid.size())
    if (const double last = edge(altitude, out.time.back(), grid[behind]); last > out.time.back())
      put(last, false);
  if (first > 0)
    if (const double next = edge(altitude, out.time.front(), grid[first - 1]);
        next < out.time.front())
      put(next, true);
  return out;
}

/// Moves samples to tops that stand between them, where such a top may be above.
void put_tops(Samples &samples, const Function &above, const std::atomic<bool> *cancel) {
  auto &[time, value] = samples;
  for (std::size_t k = 1; k + 1 < time.size() && !is_set(cancel); ++k) {
    const double here = value[k];
    // The top reaches further than the samples by less than their spread.
    const double reach = std::max(here - value[k - 1], here - value[k + 1]);
    if (here < value[k - 1] || here < value[k + 1] || here > 0 || here + reach < 0)
      continue;
    const double top = maximum(above, time[k - 1], time[k + 1]);
    if (const double highest = above(top); highest > 0) {
      time[k] = top;
      value[k] = highest;
    }
  }
}

std::vector<Stretch> stretches(const Samples &samples, const Function &above,
                               const std::atomic<bool> *cancel) {
  const auto &[time, value] = samples;
  std::vector<Stretch> out;
  const std::size_t n = time.size();
  for (std::size_t k = 0; k < n && !is_set(cancel); ++k) {
    if (!(value[k] > 0))
      continue;
    Stretch one{time[k], time[k], time[k], k == 0, false};
    if (k > 0)
      one.rise_s = crossing(above, time[k - 1], time[k]);
    std::size_t best = k;
    for (; k + 1 < n && value[k + 1] > 0; ++k)
      best = value[k + 1] > value[best] ? k + 1 : best;
    one.is_set_cut = k + 1 == n;
    one.set_s = one.is_set_cut ? time[k] : crossing(above, time[k], time[k + 1]);
    const double low = std::max(one.rise_s, best > 0 ? time[best - 1] : one.rise_s);
    const double high = std::min(one.set_s, best + 1 < n ? time[best + 1] : one.set_s);
    one.top_s = maximum(above, low, high);
    // At a cut end the top may be the end itself.
    for (const double end : {one.rise_s, one.set_s})
      if (above(end) > above(one.top_s))
        one.top_s = end;
    out.push_back(one);
  }
  return out;
}

/// Walks on while the altitude grows; returns where it no longer does. Nothing where it still
/// climbs after an hour: what stands in the sky for hours has no summit that a night would be
/// called by.
std::optional<double> walk_uphill(const Altitude &altitude, double step_s) {
  constexpr double longest_s = 3600; // longer than any passage of a low orbit
  double best = 0, highest = altitude(0);
  for (double next; (next = altitude(best + step_s)) > highest; highest = next)
    if (std::abs(best += step_s) > longest_s)
      return {};
  return best;
}

} // namespace

namespace passes {

// By bisection: the visible part of the Sun is 0 or 1 on nearly all of the way, where root finders
// that follow slopes gain nothing.
double crossing(const Function &f, double a, double b) {
  const bool is_up = f(b) > 0;
  while (b - a > crossing_tolerance_s) {
    const double middle = 0.5 * (a + b);
    ((f(middle) > 0) == is_up ? b : a) = middle;
  }
  return 0.5 * (a + b);
}

Found search(const Trajectory &orbit, const Site &site, Epoch<Utc> start, Epoch<Utc> stop,
             Angle altitude_min, const std::atomic<bool> *cancel) {
  const Altitude altitude(orbit, site, start);
  const double wanted = altitude_min.radians();
  const Function above = [&](double seconds) { return altitude(seconds) - wanted; };
  Found out;
  const auto grid = coarse_times(orbit, std::max(0.0, seconds_between(stop, start)));
  const bool may_resume = orbit.elements() == nullptr; // what has decayed has decayed
  std::optional<double> last;
  for (std::size_t k = 0; k < grid.size() && !is_set(cancel);) {
    if (!altitude.is_there(grid[k])) {
      if (!out.end)
        out.end = OrbitEnd{altitude.time(last.value_or(grid[0])), altitude.error(grid[k])};
      if (!may_resume)
        break;
      ++k;
      continue;
    }
    Samples samples = sample(altitude, grid, k, cancel);
    if (samples.above.empty())
      break;
    if (last)
      out.gaps.push_back({altitude.time(*last), altitude.time(samples.time.front())});
    out.end.reset();
    last = samples.time.back();
    while (k < grid.size() && grid[k] <= *last)
      ++k;
    for (double &value : samples.above)
      value -= wanted;
    put_tops(samples, above, cancel);
    const auto found = stretches(samples, above, cancel);
    out.stretches.insert(out.stretches.end(), found.begin(), found.end());
  }
  return out;
}

} // namespace passes

PassSpans find_pass_spans(const Trajectory &orbit, const Site &site, Epoch<Utc> start,
                          Epoch<Utc> stop, Angle altitude_min, const std::atomic<bool> *cancel) {
  auto found = passes::search(orbit, site, start, stop, altitude_min, cancel);
  PassSpans out{{}, std::move(found.gaps), std::move(found.end)};
  for (const Stretch &one : found.stretches)
    out.spans.push_back({.rise = plus_seconds(start, one.rise_s),
                         .set = plus_seconds(start, one.set_s),
                         .culmination = plus_seconds(start, one.top_s),
                         .is_rise_cut = one.is_rise_cut,
                         .is_set_cut = one.is_set_cut});
  return out;
}

Epoch<Utc> culmination_near(const Trajectory &orbit, const Site &site, Epoch<Utc> near) {
  const Altitude altitude(orbit, site, near);
  constexpr double stride_s = 10; // shorter than any passage above the horizon
  const auto before = walk_uphill(altitude, -stride_s);
  const auto summit = before && *before < 0 ? before : walk_uphill(altitude, stride_s);
  if (!before || !summit)
    return near;
  const double top =
      maximum(altitude, *summit - stride_s, *summit + stride_s, crossing_tolerance_s);
  return altitude.time(altitude(top) > altitude(*summit) ? top : *summit); // where an orbit ends
}

} // namespace umov
