// Passes: altitude on a coarse grid, its maxima and crossings refined.

#include <umov/orbit/passes.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <umov/core/golden_section.h>
#include <umov/core/quantity.h>

namespace umov {
namespace {

constexpr double time_tolerance_s = 1e-3;

/// The object over the site, at seconds after the start.
class Tracker {
public:
  Tracker(const Trajectory &orbit, const Site &site, Epoch<Utc> start, ShadowModel shadow)
      : orbit_(orbit), site_(site), start_(start), shadow_(shadow) {}

  /// Zeros where the orbit ends; `failed` tells the first time.
  ObservingGeometry at(double seconds) {
    const Epoch<Utc> time = plus_seconds(start_, seconds);
    const auto state = ask(time);
    return state ? observe(*state, time, site_, shadow_) : ObservingGeometry{};
  }
  double altitude(double seconds) {
    const Epoch<Utc> time = plus_seconds(start_, seconds);
    const auto state = ask(time);
    return state ? topocentric_altitude(*state, time, site_).radians() : 0;
  }
  /// Altitudes at many times; shorter where the orbit ends.
  std::vector<double> altitudes(const std::vector<double> &seconds) {
    std::vector<Epoch<Utc>> times;
    for (const double s : seconds)
      times.push_back(plus_seconds(start_, s));
    std::vector<TemeState> states(times.size());
    const std::size_t count = orbit_.at(times, states);
    if (count < times.size())
      ask(times[count]);
    std::vector<double> out;
    for (std::size_t k = 0; k < count; ++k)
      out.push_back(topocentric_altitude(states[k], times[k], site_).radians());
    return out;
  }
  [[nodiscard]] const std::optional<Error> &failed() const { return failed_; }

private:
  Result<TemeState> ask(Epoch<Utc> time) {
    auto state = orbit_.at(time);
    if (!state && !failed_)
      failed_ = state.error();
    return state;
  }
  const Trajectory &orbit_;
  const Site &site_;
  Epoch<Utc> start_;
  ShadowModel shadow_;
  std::optional<Error> failed_;
};

/// Where f changes sign between a and b, by bisection: the visible part of the Sun is 0 or 1 on
/// nearly all of the way, where root finders that follow slopes gain nothing.
double crossing(const std::function<double(double)> &f, double a, double b) {
  const bool is_up = f(b) > 0;
  while (b - a > time_tolerance_s) {
    const double middle = 0.5 * (a + b);
    ((f(middle) > 0) == is_up ? b : a) = middle;
  }
  return 0.5 * (a + b);
}

/// The largest f between a and b, where it has one maximum, by golden section.
double maximum(const std::function<double(double)> &f, double a, double b) {
  constexpr double tolerance = 0.05; // flat at the top: finer steps are rounding
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

struct Stretch {
  double rise, top, set;
  bool is_rise_cut = false, is_set_cut = false;
};

/// The grid with the tops of passes between its times put in.
struct Samples {
  std::vector<double> time, above; ///< above: altitude less the wanted one [rad]
};
Samples sample(Tracker &tracker, const std::vector<double> &grid, double altitude_min,
               const std::function<double(double)> &above) {
  Samples out{grid, tracker.altitudes(grid)};
  out.time.resize(out.above.size());
  for (double &value : out.above)
    value -= altitude_min;
  if (tracker.failed())
    return out;
  for (std::size_t k = 1; k + 1 < out.time.size(); ++k) {
    const double here = out.above[k];
    // The top reaches further than the samples by less than their spread.
    const double reach = std::max(here - out.above[k - 1], here - out.above[k + 1]);
    if (here < out.above[k - 1] || here < out.above[k + 1] || here > 0 || here + reach < 0)
      continue;
    const double top = maximum(above, out.time[k - 1], out.time[k + 1]);
    if (const double value = above(top); value > 0) {
      out.time[k] = top;
      out.above[k] = value;
    }
  }
  return out;
}

std::vector<Stretch> stretches(const Samples &samples, const std::function<double(double)> &above) {
  std::vector<Stretch> out;
  const std::size_t n = samples.time.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (!(samples.above[k] > 0))
      continue;
    Stretch one{samples.time[k], samples.time[k], samples.time[k], k == 0, false};
    if (k > 0)
      one.rise = crossing(above, samples.time[k - 1], samples.time[k]);
    std::size_t best = k;
    for (; k + 1 < n && samples.above[k + 1] > 0; ++k)
      best = samples.above[k + 1] > samples.above[best] ? k + 1 : best;
    one.is_set_cut = k + 1 == n;
    one.set =
        one.is_set_cut ? samples.time[k] : crossing(above, samples.time[k], samples.time[k + 1]);
    const double low = std::max(one.rise, best > 0 ? samples.time[best - 1] : one.rise);
    const double high = std::min(one.set, best + 1 < n ? samples.time[best + 1] : one.set);
    one.top = maximum(above, low, high);
    // At a cut end the top may be the end itself.
    for (const double end : {one.rise, one.set})
      if (above(end) > above(one.top))
        one.top = end;
    out.push_back(one);
  }
  return out;
}

/// Everything along a pass that needs samples: shadow, phase, range. Returns them if they are
/// wanted.
std::vector<ObservingGeometry> describe(Tracker &tracker, const Stretch &stretch,
                                        const PassSearch &search, SitePass &out) {
  std::vector<ObservingGeometry> samples;
  constexpr double step_max = 5;
  const double length = stretch.set - stretch.rise;
  const auto steps =
      static_cast<std::size_t>(std::clamp(std::ceil(length / step_max), 1.0, 2000.0));
  const auto light = [&](double t) { return tracker.at(t).sunlit - 0.5; };
  double before = 0, previous_time = stretch.rise;
  std::size_t lit = 0, visible = 0;
  out.range_min_km = out.culmination.range_km;
  for (std::size_t k = 0; k <= steps; ++k) {
    const double t = stretch.rise + length * static_cast<double>(k) / static_cast<double>(steps);
    const ObservingGeometry at = tracker.at(t);
    if (search.on_pass)
      samples.push_back(at);
    const double now = at.sunlit - 0.5;
    if (k > 0 && (now > 0) != (before > 0))
      out.shadow.push_back({tracker.at(crossing(light, previous_time, t)).time, before > 0});
    before = now;
    previous_time = t;
    out.range_min_km = std::min(out.range_min_km, at.range_km);
    if (!(at.sunlit > 0))
      continue;
    out.phase_min =
        lit == 0 ? at.phase_angle
                 : Angle::radians(std::min(out.phase_min.radians(), at.phase_angle.radians()));
    out.phase_max =
        lit == 0 ? at.phase_angle
                 : Angle::radians(std::max(out.phase_max.radians(), at.phase_angle.radians()));
    ++lit;
    visible += at.sun_altitude.radians() < search.sun_altitude_max.radians() ? 1u : 0u;
  }
  const double share = 1 / static_cast<double>(steps + 1);
  out.sunlit_share = static_cast<double>(lit) * share;
  out.visible_s = static_cast<double>(visible) * share * length;
  return samples;
}

} // namespace

Result<std::vector<SitePass>> find_passes(const Trajectory &orbit, const Site &site,
                                          Epoch<Utc> start, Epoch<Utc> stop,
                                          const PassSearch &search) {
  Tracker tracker(orbit, site, start, search.shadow);
  const double span_s = std::max(0.0, seconds_between(stop, start));
  const auto above = [&](double t) { return tracker.altitude(t) - search.altitude_min.radians(); };
  const Samples samples =
      sample(tracker, coarse_times(orbit, span_s), search.altitude_min.radians(), above);
  std::vector<SitePass> out;
  for (const Stretch &stretch :
       tracker.failed() ? std::vector<Stretch>() : stretches(samples, above)) {
    SitePass pass;
    pass.rise = tracker.at(stretch.rise);
    pass.culmination = tracker.at(stretch.top);
    pass.set = tracker.at(stretch.set);
    pass.is_rise_cut = stretch.is_rise_cut;
    pass.is_set_cut = stretch.is_set_cut;
    const auto along = describe(tracker, stretch, search, pass);
    if (search.on_pass && !tracker.failed())
      UMOV_TRY(search.on_pass(pass, along));
    out.push_back(std::move(pass));
  }
  if (const auto &failed = tracker.failed())
    return tl::unexpected(*failed);
  return out;
}

} // namespace umov
