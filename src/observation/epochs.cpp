#include <umov/observation/epochs.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/parallel.h>
#include <umov/orbit/passes.h>

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

/// The Sun higher at the site than the filter lets it.
bool is_light(const EpochGeometry &epoch, const EpochFilter &only) {
  return only.sun_altitude_max &&
         epoch.geometry.sun_altitude.radians() > only.sun_altitude_max->radians();
}

/// Above the altitude limit, and dark and sunlit as the filter asks.
bool is_kept(const EpochGeometry &epoch, const EpochFilter &only) {
  return is_above(epoch, only) && !is_light(epoch, only) &&
         (!only.sunlit || epoch.geometry.sunlit > 0);
}

/// A scenario calls the span [time].
Error in_scenario_words(Error error) {
  constexpr std::string_view plain = "Shorten the span";
  if (const std::size_t at = error.message.find(plain); at != std::string::npos)
    error.message.replace(at, plain.size(), "Shorten [time]");
  return error;
}

/// Epochs [first, behind) of a grid that lie in a pass.
struct GridPass {
  PassSpan span;
  std::size_t first = 0, behind = 0;
};

/// The passes of a grid: no epoch outside them is above the altitude limit.
struct GridPasses {
  std::vector<GridPass> passes;
  std::size_t in_gaps = 0;      ///< epochs that the orbit does not cover, though it does later ones
  std::optional<Error> stopped; ///< at the first epoch after the orbit's end
  std::size_t behind = 0;       ///< epochs before that
};

constexpr double slack_s = 2e-3; // crossings and edges are good to a millisecond

GridPasses find_on_grid(const TrackRequest &track, const std::vector<Epoch<Utc>> &times,
                        Angle altitude_min, const std::atomic<bool> &cancel) {
  const auto index = [&times](Epoch<Utc> time) {
    const auto at = std::partition_point(times.begin(), times.end(), [time](Epoch<Utc> one) {
      return seconds_between(one, time) < 0;
    });
    return static_cast<std::size_t>(at - times.begin());
  };
  const PassSpans found =
      find_pass_spans(track.orbit, track.site, times.front(), times.back(), altitude_min, &cancel);
  GridPasses out{{}, 0, {}, times.size()};
  for (const PassSpan &span : found.spans)
    out.passes.push_back(
        {span, index(plus_seconds(span.rise, -slack_s)), index(plus_seconds(span.set, slack_s))});
  for (const OrbitGap &gap : found.gaps)
    out.in_gaps += index(plus_seconds(gap.next, -slack_s)) - index(plus_seconds(gap.last, slack_s));
  if (!found.end)
    return out;
  const std::size_t first = index(plus_seconds(found.end->last, slack_s));
  const std::size_t ended = track.orbit.at(times.front()) ? first : 0;
  if (ended < times.size()) {
    const auto state = track.orbit.at(times[ended]);
    out.stopped = in_scenario_words(state ? found.end->error : state.error());
    out.behind = ended;
  }
  return out;
}

/// Epochs per work unit.
constexpr std::size_t block = 256;

/// Geometry at all epochs of all passes, pass after pass.
std::vector<EpochGeometry> observe_grid(const Track &track, const std::vector<Epoch<Utc>> &times,
                                        const std::vector<GridPass> &passes, unsigned threads,
                                        const std::atomic<bool> &cancel) {
  std::vector<std::size_t> wanted;
  for (const GridPass &pass : passes)
    for (std::size_t i = pass.first; i < pass.behind; ++i)
      wanted.push_back(i);
  std::vector<EpochGeometry> out(wanted.size());
  parallel_for((out.size() + block - 1) / block, threads, [&](std::size_t b) {
    for (std::size_t k = b * block; !cancel && k < std::min((b + 1) * block, out.size()); ++k)
      out[k] = geometry_at(track, times[wanted[k]]);
  });
  return out;
}

/// Name, culmination (whole, whatever the span cuts) and limits of a pass.
Pass describe_pass(const Track &track, const PassSpan &span, Epoch<Utc> first, Epoch<Utc> last) {
  const auto &request = track.request();
  Pass out;
  out.rise = first;
  out.set = last;
  out.culmination = culmination_near(request.orbit, request.site, span.culmination);
  if (const auto state = request.orbit.at(out.culmination))
    out.culmination_altitude = topocentric_altitude(*state, out.culmination, request.site);
  out.id = pass_id(request.orbit, out.culmination);
  return out;
}

/// Epochs of one's own may leave a pass anywhere: it is up before the first of them, after the
/// last.
void open_by_own(Pass &pass, const PassSpan &span) {
  pass.is_open_at_start |= seconds_between(pass.rise, span.rise) > slack_s;
  pass.is_open_at_end |= seconds_between(span.set, pass.set) > slack_s;
}

/// Adds what the filter keeps of the epochs of one pass, from `grid` on.
void add_pass(KeptEpochs &out, const Track &track, const GridPass &pass,
              std::span<const EpochGeometry> grid, std::size_t behind, const EpochFilter &only,
              bool is_own) {
  const auto above = [&only](const EpochGeometry &epoch) { return is_above(epoch, only); };
  const auto first = std::find_if(grid.begin(), grid.end(), above);
  if (first == grid.end())
    return;
  ++out.passes_seen;
  const std::size_t before = out.geometry.size();
  for (const EpochGeometry &epoch : grid)
    if (is_kept(epoch, only)) {
      out.geometry.push_back(epoch.geometry);
      out.pass.push_back(out.passes.size());
    } else if (above(epoch)) {
      ++(is_light(epoch, only) ? out.in_light_sky : out.in_shadow);
    }
  if (out.geometry.size() == before)
    return;
  const auto last = std::find_if(grid.rbegin(), grid.rend(), above);
  out.passes.push_back(describe_pass(track, pass.span, first->geometry.time, last->geometry.time));
  Pass &described = out.passes.back();
  described.is_open_at_start = pass.first == 0 && first == grid.begin();
  described.is_open_at_end = pass.behind == behind && last == grid.rbegin();
  if (is_own)
    open_by_own(described, pass.span);
  described.rows = out.geometry.size() - before;
}

/// Epochs of one's own stand in order, each once: what lies between two of them is looked up. Times
/// of tables have milliseconds; closer epochs would be one there.
Result<std::size_t> count_of_own(const std::vector<Epoch<Utc>> &own) {
  if (own.size() > max_epochs)
    return fail(ErrorCode::BadInput,
                fmt::format("{} epochs; the limit is {}", own.size(), max_epochs));
  constexpr double least_s = 1e-3 - 1e-9;
  const auto back = std::ranges::adjacent_find(
      own, [](Epoch<Utc> a, Epoch<Utc> b) { return !(seconds_between(b, a) > least_s); });
  if (back != own.end())
    return fail(ErrorCode::BadInput,
                fmt::format("epoch {} is {}, and the one before it {}; epochs in order of time, "
                            "each once and a millisecond apart, were expected",
                            back - own.begin() + 2, to_iso_exact(*(back + 1)),
                            to_iso_exact(*back)));
  return own.size();
}

} // namespace

std::string pass_id(const Trajectory &orbit, Epoch<Utc> culmination) {
  std::string time = to_iso(culmination).substr(0, 19) + "Z";
  std::erase_if(time, [](char c) { return c == '-' || c == ':'; });
  return orbit.id() + "-" + time;
}

Result<std::size_t> epoch_count(const EpochSpan &of) {
  if (!of.own.empty())
    return count_of_own(of.own);
  const auto &start = of.start, &stop = of.stop;
  const double step_s = of.step_s;
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
  return static_cast<std::size_t>(steps) + 1;
}

Epoch<Utc> epoch_of(const EpochSpan &span, std::size_t index) {
  if (!span.own.empty())
    return span.own[index];
  return plus_seconds(span.start, static_cast<double>(index) * span.step_s);
}

Result<std::vector<Epoch<Utc>>> time_grid(const EpochSpan &of, const std::atomic<bool> *cancel) {
  UMOV_ASSIGN(count, epoch_count(of));
  std::vector<Epoch<Utc>> out(count);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (cancel != nullptr && *cancel)
      return fail(ErrorCode::Interrupted, "stopped before the first row");
    out[i] = epoch_of(of, i);
  }
  return out;
}

Result<KeptEpochs> keep_epochs(const Track &track, const EpochSpan &span, const EpochFilter &only,
                               unsigned threads, const std::atomic<bool> &cancel) {
  UMOV_ASSIGN(times, time_grid(span, &cancel));
  GridPasses found = find_on_grid(track.request(), times, only.altitude_min, cancel);
  const auto grid = observe_grid(track, times, found.passes, threads, cancel);
  if (cancel)
    return fail(ErrorCode::Interrupted, "stopped before the first row");
  KeptEpochs out;
  out.stopped = std::move(found.stopped);
  out.before_end = found.behind;
  // Gaps shorter than the search's step are met here, if an epoch falls into them.
  const auto missed = std::count_if(grid.begin(), grid.end(),
                                    [](const EpochGeometry &epoch) { return !epoch.is_there; });
  out.epochs_in_gaps = found.in_gaps + static_cast<std::size_t>(missed);
  std::size_t at = 0;
  for (const GridPass &pass : found.passes) {
    const std::size_t count = pass.behind - pass.first;
    add_pass(out, track, pass, std::span(grid).subspan(at, count), found.behind, only,
             !span.own.empty());
    at += count;
  }
  return out;
}

std::optional<NextPass> find_next_pass(const Track &track, const EpochFilter &only, Epoch<Utc> from,
                                       double days) {
  constexpr double step_s = 20; // shorter than any useful pass; the time is told to the minute
  const auto &request = track.request();
  const PassSpans found = find_pass_spans(request.orbit, request.site, from,
                                          plus_seconds(from, days * 86400), only.altitude_min);
  for (const PassSpan &span : found.spans) {
    std::optional<NextPass> next;
    for (double s = 0; s <= seconds_between(span.set, span.rise); s += step_s) {
      const EpochGeometry at = geometry_at(track, plus_seconds(span.rise, s));
      if (!is_kept(at, only))
        continue;
      if (!next)
        next = NextPass{at.geometry.time, at.geometry.altitude};
      else
        next->altitude_max =
            Angle::radians(std::max(next->altitude_max.radians(), at.geometry.altitude.radians()));
    }
    if (next)
      return next;
  }
  return {};
}

} // namespace umov
