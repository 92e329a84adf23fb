#include <umov/observation/epochs.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/golden_section.h>
#include <umov/core/parallel.h>

namespace umov {
namespace {

constexpr std::size_t max_epochs = 10'000'000;

/// Geometry of one epoch of the grid, unless the orbit could not be had there.
struct EpochGeometry {
  bool is_there = false;
  ObservingGeometry geometry;
};

EpochGeometry geometry_at(const Track &track, Epoch<Utc> time) {
  const auto geometry = track.observe(time);
  return geometry ? EpochGeometry{true, *geometry} : EpochGeometry{};
}

bool is_above(const EpochGeometry &epoch, const EpochFilter &only) {
  return epoch.is_there && epoch.geometry.altitude.radians() >= only.altitude_min.radians();
}

/// Above the altitude limit, and dark and sunlit as the filter asks.
bool is_kept(const EpochGeometry &epoch, const EpochFilter &only) {
  if (!is_above(epoch, only))
    return false;
  if (only.sun_altitude_max &&
      epoch.geometry.sun_altitude.radians() > only.sun_altitude_max->radians())
    return false;
  return !only.sunlit || epoch.geometry.sunlit > 0;
}

/// Consecutive epochs above the altitude limit, [first, last] into the grid.
struct GridPass {
  std::size_t first = 0, last = 0;
};

std::vector<GridPass> group_passes(const std::vector<EpochGeometry> &grid,
                                   const EpochFilter &only) {
  std::vector<GridPass> passes;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (!is_above(grid[i], only))
      continue;
    if (i > 0 && is_above(grid[i - 1], only))
      passes.back().last = i;
    else
      passes.push_back({i, i});
  }
  return passes;
}

/// Highest point of a passage: seconds after `from`, where the altitude is greatest near [low,
/// high].
struct Summit {
  double seconds, altitude_rad;
};

class Climb {
public:
  Climb(const Track &track, Epoch<Utc> origin) : track_(track), origin_(origin) {}

  /// Walks on while the altitude grows; returns where it no longer does.
  [[nodiscard]] double walk(double from, double step) const {
    constexpr double longest_s = 21'600; // what still climbs after that hardly moves: no summit
    double best = from, highest = altitude(from);
    for (double next; (next = altitude(best + step)) > highest; highest = next)
      if (std::abs((best += step) - from) > longest_s)
        return from;
    return best;
  }
  /// To a millisecond, so that the name of a pass does not depend on the step.
  [[nodiscard]] Summit refine(double low, double high) const {
    const double top = golden_minimum([&](double s) { return -altitude(s); }, low, high, 1e-3);
    return {top, altitude(top)};
  }

private:
  [[nodiscard]] double altitude(double seconds) const {
    const auto at = track_.observe(plus_seconds(origin_, seconds));
    return at ? at->altitude.radians() : -pi;
  }
  const Track &track_;
  Epoch<Utc> origin_;
};

/// Name, culmination (refined between epochs to 1 ms) and limits of a pass.
Pass describe_pass(const GridPass &pass, const std::vector<EpochGeometry> &grid,
                   const Track &track) {
  std::size_t top = pass.first;
  for (std::size_t i = pass.first; i <= pass.last; ++i)
    if (grid[i].geometry.altitude.radians() > grid[top].geometry.altitude.radians())
      top = i;
  Pass out;
  out.rise = grid[pass.first].geometry.time;
  out.set = grid[pass.last].geometry.time;
  out.is_open_at_start = pass.first == 0;
  out.is_open_at_end = pass.last + 1 == grid.size();
  const Epoch<Utc> origin = grid[top].geometry.time;
  const Climb climb(track, origin);
  constexpr double stride_s = 10; // shorter than any passage above the horizon
  double low = -stride_s, high = stride_s;
  if (top > pass.first)
    low = seconds_between(grid[top - 1].geometry.time, origin);
  else if (const double summit = climb.walk(0, -stride_s); summit < 0) {
    low = summit - stride_s; // the span cuts the pass: it keeps the name that it has as a whole
    high = summit + stride_s;
  }
  if (top < pass.last)
    high = seconds_between(grid[top + 1].geometry.time, origin);
  else if (const double summit = climb.walk(0, stride_s); summit > 0) {
    low = summit - stride_s;
    high = summit + stride_s;
  }
  const Summit summit = climb.refine(low, high);
  out.culmination = plus_seconds(origin, summit.seconds);
  out.culmination_altitude = Angle::radians(summit.altitude_rad);
  out.id = pass_id(track.request().orbit, out.culmination);
  return out;
}

/// A scenario calls the span [time].
Error in_scenario_words(Error error) {
  constexpr std::string_view plain = "Shorten the span";
  if (const std::size_t at = error.message.find(plain); at != std::string::npos)
    error.message.replace(at, plain.size(), "Shorten [time]");
  return error;
}

/// Epochs per work unit.
constexpr std::size_t block = 256;

} // namespace

std::string pass_id(const Trajectory &orbit, Epoch<Utc> culmination) {
  std::string time = to_iso(culmination).substr(0, 19) + "Z";
  std::erase_if(time, [](char c) { return c == '-' || c == ':'; });
  return orbit.id() + "-" + time;
}

Result<std::vector<Epoch<Utc>>> time_grid(const EpochSpan &of) {
  const auto &[start, stop, step_s] = of;
  if (!(step_s > 0) || !std::isfinite(step_s))
    return fail(ErrorCode::BadInput,
                fmt::format("the step is {} s; a positive number was expected", step_s));
  const double span = seconds_between(stop, start);
  if (span < 0)
    return fail(ErrorCode::BadInput,
                "stop " + to_iso(stop) + " is before start " + to_iso(start) + "; exchange them");
  // A microsecond of slack keeps `stop` in when the step divides the span.
  const double steps = std::floor((span + 1e-6) / step_s);
  if (steps >= static_cast<double>(max_epochs))
    return fail(ErrorCode::BadInput,
                fmt::format("{:.0f} epochs asked for; the limit is {}. Take a longer step or a "
                            "shorter span.",
                            steps + 1, max_epochs));
  std::vector<Epoch<Utc>> out(static_cast<std::size_t>(steps) + 1);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = plus_seconds(start, static_cast<double>(i) * step_s);
  return out;
}

Result<KeptEpochs> keep_epochs(const Track &track, const EpochSpan &span, const EpochFilter &only,
                               unsigned threads, const std::atomic<bool> &cancel) {
  UMOV_ASSIGN(times, time_grid(span));
  std::vector<EpochGeometry> grid(times.size());
  const std::size_t blocks = (times.size() + block - 1) / block;
  parallel_for(blocks, threads, [&](std::size_t b) {
    for (std::size_t i = b * block; !cancel && i < std::min((b + 1) * block, times.size()); ++i)
      grid[i] = geometry_at(track, times[i]);
  });
  if (cancel)
    return fail(ErrorCode::Interrupted, "stopped before the first row");
  KeptEpochs out;
  for (std::size_t i = 0; i < grid.size() && !out.stopped; ++i)
    if (!grid[i].is_there) {
      out.stopped = in_scenario_words(track.request().orbit.at(times[i]).error());
      grid.resize(i);
    }
  for (const GridPass &pass : group_passes(grid, only)) {
    ++out.passes_seen;
    const std::size_t before = out.geometry.size();
    for (std::size_t i = pass.first; i <= pass.last; ++i)
      if (is_kept(grid[i], only)) {
        out.geometry.push_back(grid[i].geometry);
        out.pass.push_back(out.passes.size());
      }
    if (out.geometry.size() == before)
      continue;
    out.passes.push_back(describe_pass(pass, grid, track));
    out.passes.back().rows = out.geometry.size() - before;
  }
  return out;
}

std::optional<NextPass> find_next_pass(const Track &track, const EpochFilter &only, Epoch<Utc> from,
                                       double days) {
  constexpr double step_s = 20; // shorter than any useful pass; the time is told to the minute
  std::optional<NextPass> found;
  for (double s = 0; s <= days * 86400; s += step_s) {
    const EpochGeometry at = geometry_at(track, plus_seconds(from, s));
    if (!at.is_there)
      return found;
    if (!found && is_kept(at, only))
      found = NextPass{at.geometry.time, at.geometry.altitude};
    else if (found && !is_above(at, only))
      return found;
    if (found && at.geometry.altitude.radians() > found->altitude_max.radians())
      found->altitude_max = at.geometry.altitude;
  }
  return found;
}

} // namespace umov
