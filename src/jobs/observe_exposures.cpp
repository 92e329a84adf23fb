#include "jobs/observe_exposures.h"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/text.h>
#include <umov/observation/epochs.h>

namespace umov::jobs {
namespace {

/// Transparency that wanders: an Ornstein-Uhlenbeck process in magnitudes.
class Cloud {
public:
  Cloud(const ScenarioObservation &o, std::uint64_t seed, std::uint32_t object)
      : sd_(o.cloud_sd_mag), time_(o.cloud_time_s), draws_({seed, object, 0, 0, 0xc10d}) {}
  double next(double elapsed_s) {
    if (!(sd_ > 0))
      return 1;
    const double kept = has_begun_ ? std::exp(-elapsed_s / time_) : 0; // any cloud at first
    has_begun_ = true;
    mag_ = mag_ * kept + sd_ * std::sqrt(1 - kept * kept) * draws_.normal();
    // Its mean is 1, as that of scintillation: magnitudes are normal, transparency is not.
    const double of_ln = 0.4 * std::log(10.) * sd_;
    return std::exp(-of_ln * of_ln / 2) * std::pow(10, -0.4 * mag_);
  }

private:
  double sd_, time_, mag_ = 0;
  bool has_begun_ = false;
  Draws draws_;
};

/// The grid of middles; BadInput with the key that asks for too much.
Result<EpochSpan> grid_of(const Scenario &scenario, const LightCurveRequest &request) {
  const ScenarioObservation &o = *scenario.observation;
  if (!request.span.own.empty())
    return fail(ErrorCode::BadInput,
                "[time] has epochs; start and stop were expected, between which exposures begin "
                "every observation.cadence_s",
                scenario.place("time.epochs"));
  const double half = o.exposure_s / 2;
  EpochSpan span{plus_seconds(request.span.start, half), plus_seconds(request.span.stop, -half),
                 o.cadence_s};
  // Times of day are known to a part of a microsecond: an exposure may fill its span.
  constexpr double rounding_s = 1e-6;
  const double room_s = seconds_between(span.stop, span.start);
  if (room_s < 0 && room_s > -rounding_s)
    span.stop = span.start;
  else if (room_s < 0)
    return fail(ErrorCode::BadInput,
                fmt::format("exposure_s = {} is longer than the span of [time], {} s; shorten one "
                            "or lengthen the other",
                            o.exposure_s,
                            shortest(seconds_between(request.span.stop, request.span.start))),
                scenario.place("observation.exposure_s"));
  if (const auto count = epoch_count(span); !count)
    return fail(count.error().code,
                fmt::format("exposures every {} s: {}", o.cadence_s, count.error().message),
                scenario.place("observation.cadence_s"));
  return span;
}

LeftOut left_out_of(const KeptEpochs &kept, std::size_t all) {
  LeftOut out;
  out.light = kept.in_light_sky;
  out.shadow = kept.in_shadow;
  out.gaps = kept.epochs_in_gaps;
  if (kept.stopped) {
    out.end = kept.stopped;
    out.unknown = all - std::min(all, kept.before_end);
  }
  const std::size_t others = kept.geometry.size() + out.sum();
  out.low = all - std::min(all, others);
  return out;
}

/// "12 of 80 exposures left out: 9 below the horizon, 3 in the Earth's shadow"; empty for none.
std::string words_of(const LeftOut &left_out, std::size_t all, const EpochFilter &only) {
  if (left_out.sum() == 0)
    return "";
  std::vector<std::string> reasons;
  const auto add = [&reasons](std::size_t count, const std::string &reason) {
    if (count > 0)
      reasons.push_back(fmt::format("{} {}", count, reason));
  };
  const double lowest = only.altitude_min.degrees();
  add(left_out.low, lowest > 0 ? fmt::format("below {:g} deg (time.only.alt_min_deg)", lowest)
                               : "below the horizon");
  if (only.sun_altitude_max)
    add(left_out.light, fmt::format("with the Sun above {:g} deg (time.only.sun_alt_max_deg)",
                                    only.sun_altitude_max->degrees()));
  add(left_out.shadow, "in the Earth's shadow (time.only.sunlit)");
  add(left_out.gaps, "in gaps of the ephemeris");
  add(left_out.unknown, "after the end of the orbit");
  return fmt::format("{} of {} left out: {}", left_out.sum(), counted(all, "exposure"),
                     fmt::join(reasons, ", "));
}

} // namespace

Result<ExposureList> exposures_of(const Scenario &scenario, const Track &track,
                                  const LightCurveRequest &request, const Programme &programme,
                                  std::uint32_t object, const Monitor &monitor) {
  const ScenarioObservation &o = *scenario.observation;
  UMOV_ASSIGN(span, grid_of(scenario, request));
  UMOV_ASSIGN(all, epoch_count(span));
  UMOV_ASSIGN(kept, keep_epochs(track, span, request.only, request.threads, monitor.cancel_flag()));
  ExposureList out;
  out.left_out = left_out_of(kept, all);
  Draws clock({scenario.seed, object, 0, 0, 0xc10c});
  const double clock_error = o.clock_error_s * clock.normal();
  Cloud cloud(o, scenario.seed, object);
  out.exposures.reserve(kept.geometry.size());
  for (const ObservingGeometry &g : kept.geometry) {
    if (!(g.altitude.radians() > 0)) { // there is no air mass below the horizon
      ++out.left_out.low;
      continue;
    }
    const auto k =
        static_cast<std::size_t>(std::llround(seconds_between(g.time, span.start) / o.cadence_s));
    const double elapsed =
        out.exposures.empty() ? 0 : seconds_between(g.time, out.exposures.back().middle.time);
    out.exposures.push_back(
        {programme.at(k), g, plus_seconds(g.time, clock_error), cloud.next(elapsed)});
  }
  return out;
}

std::string tell_left_out(const LeftOut &left_out, std::size_t all, const Scenario &scenario,
                          const std::string &object, Diagnostics &diagnostics) {
  const EpochFilter &only = scenario.time->only;
  const std::string words = words_of(left_out, all, only);
  if (words.empty())
    return "";
  const bool is_unasked = left_out.gaps + left_out.unknown > 0 ||
                          (left_out.low > 0 && !(only.altitude_min.radians() > 0));
  std::string told = object + ": " + words + (left_out.end ? ". " + left_out.end->message : "");
  if (!is_unasked)
    return told;
  diagnostics.warn(told, scenario.place("time.start"));
  return "";
}

Result<void> check_air(const std::vector<Exposure> &exposures, const Setup &s,
                       Diagnostics &diagnostics) {
  const SkyOptions &sky = s.observation.sky;
  std::size_t low = 0, day = 0, aside = 0;
  for (const Exposure &e : exposures) {
    const ObservingGeometry &g = e.middle;
    low += apparent_altitude(550, g.altitude, s.surface).degrees() < 3 ? 1u : 0u;
    day += is_day(sky, g.sun_altitude) ? 1u : 0u;
    constexpr double last_twilight = -15, farthest = 50; // 40 deg from the zenith
    aside += sky.has_twilight && !sky.mag && g.sun_altitude.degrees() > last_twilight &&
                     g.altitude.degrees() < farthest
                 ? 1u
                 : 0u;
  }
  if (day > 0)
    return fail(ErrorCode::BadInput,
                fmt::format("{} of {} with the Sun above -5 deg, where the model of twilight knows "
                            "no brightness: leave them out with time.only.sun_alt_max_deg = -5, or "
                            "give atmosphere.sky.mag",
                            counted(day, "exposure"), exposures.size()),
                s.scenario.place("time.only"));
  if (low > 0)
    diagnostics.warn(fmt::format("{} below an apparent altitude of 3 deg: air mass is "
                                 "extrapolated there",
                                 counted(low, "exposure")));
  if (aside > 0)
    diagnostics.warn(
        fmt::format("{} in twilight more than 40 deg from the zenith: the sky's "
                    "brightness is that of the zenith, which is known; towards the Sun "
                    "it is brighter",
                    counted(aside, "exposure")));
  return {};
}

} // namespace umov::jobs
