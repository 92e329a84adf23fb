#include <umov/jobs/run.h>

#include "jobs/haze_spread.h"
#include "jobs/job_journal.h"
#include "jobs/run_report.h"
#include "jobs/standing.h"
#include "jobs/wanted_passes.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/stop.h>
#include <umov/core/text.h>
#include <umov/time/earth_orientation.h>

namespace umov::jobs {
namespace {

/// No row is a result of its own kind: it says when there will be one.
Result<Error> nothing_found(const LightCurveRequest &request) {
  UMOV_ASSIGN(track, Track::make(request.track));
  const EpochSpan &span = request.span;
  const double span_days = seconds_between(span.stop, span.start) / 86400;
  if (const auto missed = find_next_pass(track, request.only, span.start, span_days))
    return Error{
        ErrorCode::Nothing,
        fmt::format(
            "no epoch {} falls in a pass, but there is one near {}Z, max alt {:.0f}{}",
            span.own.empty() ? "of the grid" : "of [time] epochs",
            to_iso(missed->first_row).substr(0, 16), missed->altitude_max.degrees(),
            span.own.empty()
                ? fmt::format(": step_s = {:g} is longer than the pass. Take a shorter step.",
                              span.step_s)
                : ". Give epochs within it."),
        {}};
  std::string text = fmt::format(
      "no {}pass of {} above {:g} deg{} from {} in that span.",
      request.only.sunlit ? "sunlit " : "", request.track.orbit.id(),
      request.only.altitude_min.degrees(),
      request.only.sun_altitude_max
          ? fmt::format(" with the Sun below {:g} deg", request.only.sun_altitude_max->degrees())
          : "",
      request.track.site.name.empty() ? "the site" : "\"" + request.track.site.name + "\"");
  constexpr double days = 14; // beyond it the elements say little
  if (const auto next = find_next_pass(track, request.only, span.stop, days))
    text += fmt::format(" The next one: {}Z, max alt {:.0f}.",
                        to_iso(next->first_row).substr(0, 16), next->altitude_max.degrees());
  else
    text += fmt::format(" None in the next {:.0f} days either.{}", days,
                        where_it_stands(request.track.orbit, request.track.site, span.start,
                                        request.only.altitude_min));
  return Error{ErrorCode::Nothing, text, {}};
}

/// Rows whose numerical error stayed above what was asked are told, not hidden.
void warn_of_accuracy(const LightCurveOutcome &outcome, const LightOptions &light,
                      const std::vector<double> &floor_i, Diagnostics &diagnostics) {
  const double accuracy = light.accuracy;
  const LightCurve &curve = outcome.curve;
  const std::size_t bands = curve.bands.size();
  std::size_t count = 0;
  double worst = 0;
  for (std::size_t i = 0; i < curve.epochs.size(); ++i) {
    double error = 0;
    for (std::size_t b = 0; b < bands; ++b)
      if (const LightCurveSample &s = curve.samples[i * bands + b]; s.intensity > 0)
        error = std::max(error,
                         s.half_width.i / std::max(s.intensity, floor_i.empty() ? 0 : floor_i[b]));
    count += error > 1.001 * accuracy ? 1u : 0u;
    worst = std::max(worst, error);
  }
  if (count > 0)
    diagnostics.warn(fmt::format(
        "{} of {} epochs did not reach the accuracy {:g} asked of I ({}){}. See intensity_err.",
        count, curve.epochs.size(), accuracy,
        worst < 1 ? fmt::format("worst {:.3g}", worst) : "some are not known at all",
        light.method == LightMethod::Masks
            ? ": masks alone are as good as they are; render.method = \"auto\" mends them by rays"
            : ": the largest number of points per pose was reached"));
}

/// The same of bands whose sum of wavelengths is not as good as theirs should be.
void warn_of_bands(const LightCurve &curve, Diagnostics &diagnostics) {
  constexpr double wanted = 1e-3; // docs/theory/bands.md, Eq. 8
  std::size_t count = 0;
  double worst = 0;
  for (const LightCurveSample &s : curve.samples) {
    const Stokes<ScatteringPlane> &e = s.band_err;
    const double error = s.intensity > 0 ? std::max({e.i, e.q, e.u}) / s.intensity : 0;
    count += error > wanted ? 1u : 0u;
    worst = std::max(worst, error);
  }
  if (count > 0)
    diagnostics.warn(
        fmt::format("{} of {} rows have light whose colours change within the band faster "
                    "than its wavelengths follow: up to {:.2g} of I, see band_err_*",
                    count, curve.samples.size(), worst));
}

/// The same of the Earth's light, whose patches are cut up to a bound.
void warn_of_earth(const LightCurveOutcome &outcome, const EarthshineOptions &options,
                   Diagnostics &diagnostics) {
  std::size_t count = 0;
  double worst = 0;
  const std::size_t bands = outcome.curve.bands.size();
  for (const SecondLight &light : outcome.curve.second_lights)
    for (std::size_t i = 0; light.source == SecondSource::Earth && i < outcome.curve.epochs.size();
         ++i) {
      double error = 0;
      for (std::size_t b = 0; b < bands; ++b)
        if (const double full = light.intensity[i * bands + b].i; full > 0)
          error = std::max(error, light.half_width[i * bands + b].i / full);
      count += error > 1.5 * options.accuracy ? 1u : 0u; // the mask's own error comes on top
      worst = std::max(worst, error);
    }
  if (count > 0)
    diagnostics.warn(
        fmt::format("{} of {} epochs did not reach the accuracy {} asked of earth_I with {} "
                    "sources (worst {:.2g}); see earth_I_err. A larger patches in earthshine "
                    "raises the bound, which is {} times as many.",
                    count, outcome.curve.epochs.size(), options.accuracy,
                    patches_bound * options.patches, worst, patches_bound));
}

/// A turn that is seen a few times only looks like another one (aliasing), and its flashes fall
/// between the rows.
void warn_of_step(const ObjectRun &one, double step_s, Diagnostics &diagnostics) {
  constexpr double rows_per_turn = 8; // four for each half, where two sides are alike
  const auto periods = turning_periods(one.request.track.attitude);
  const auto fastest = std::ranges::min_element(periods, {}, &TurningPeriod::seconds);
  if (fastest == periods.end() || step_s * rows_per_turn <= fastest->seconds)
    return;
  diagnostics.warn(
      fmt::format("{} turns in {:.3g} s ({}) and step_s = {:g} sees it {:.2g} times in "
                  "a turn: flashes are missed and the period shown may be false. "
                  "Take step_s = {:.1g} or less",
                  one.request.object, fastest->seconds, fastest->name, step_s,
                  fastest->seconds / step_s, fastest->seconds / (2 * rows_per_turn)));
}

Result<LightCurveOutcome> compute(ObjectRun &one, bool is_alone, KeptBlocks blocks,
                                  const Monitor &monitor, Diagnostics &diagnostics) {
  // A card may be lost: what was finished is in the journal.
  return without_failures([&]() -> Result<LightCurveOutcome> {
    const std::string what = is_alone ? "light curve" : one.request.object;
    monitor.advance(what, 0, 1); // the search of the epochs and the first masks take their time
    UMOV_ASSIGN(models, make_light_models(one.request, one.object.scene, monitor.cancel));
    one.light = models.light->facts();
    auto out = compute_wanted(
        one, models,
        [&](std::size_t done, std::size_t total) { monitor.advance(what, done, total); },
        monitor.cancel_flag(), blocks);
    one.light.device = lit_by(*blocks.journal, blocks.part, models.device());
    one.light.instruction_set = models.light->instruction_set();
    tell_of_device(models.device(), diagnostics);
    UMOV_TRY(models.keep_masks());
    return out;
  });
}

Result<void> spread(ObjectRun &one, KeptBlocks blocks, const Monitor &monitor,
                    Diagnostics &diagnostics) {
  Result<void> out;
  const auto done = without_failures([&]() -> Result<void> {
    out = add_haze_spread(one, blocks, monitor, diagnostics);
    return {};
  });
  if (!done) // a card, as above
    one.outcome.stopped = done.error();
  return out;
}

Result<Journal> journal_of(const std::vector<ObjectRun> &objects, const Scenario &scenario,
                           const JobOptions &options, const Monitor &monitor,
                           Diagnostics &diagnostics) {
  std::vector<InputFile> inputs;
  for (const ObjectRun &one : objects)
    inputs.insert(inputs.end(), one.object.inputs.begin(), one.object.inputs.end());
  UMOV_ASSIGN(device, device_text(options.device));
  return open_journal(options, job_text(scenario, inputs, "run" + options.part.text() + device),
                      monitor, diagnostics);
}

} // namespace

Result<std::vector<ObjectRun>> load_run(const Scenario &scenario, const JobOptions &options,
                                        const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_TRY(check_complete_for_run(scenario));
  UMOV_TRY(check_magnitudes(scenario));
  std::vector<ObjectRun> out;
  for (std::size_t k = 0; k < scenario.objects.size(); ++k) {
    UMOV_ASSIGN(object, load_object(scenario, k,
                                    {.allow_bad_checksum = options.allow_bad_checksum,
                                     .allow_old_elements = options.allow_old_elements,
                                     .cancel = monitor.cancel},
                                    diagnostics));
    LightCurveRequest request = light_curve_request(scenario, scenario.objects[k], object, options);
    for (const InputFile &input : object.inputs)
      monitor.tell(fmt::format("read {} (SHA-256 {})", input.path, input.sha256));
    out.push_back({std::move(object), std::move(request), {}, {}});
    if (scenario.time->epochs.empty()) // whoever has times of their own did not choose them here
      warn_of_step(out.back(), scenario.time->step_s, diagnostics);
  }
  if (constexpr double long_step_s = 300;
      scenario.time->epochs.empty() && scenario.time->step_s > long_step_s)
    diagnostics.warn(
        fmt::format("step_s = {:g} is long against a pass: passes between two epochs are left out",
                    scenario.time->step_s));
  warn_if_beyond_leap_seconds(scenario.time->stop, diagnostics);
  warn_if_outside_eop(scenario.time->start, scenario.time->stop, diagnostics);
  return out;
}

Result<RunResult> compute_run(std::vector<ObjectRun> objects, const Scenario &scenario,
                              const JobOptions &options, const Monitor &monitor,
                              Diagnostics &diagnostics) {
  RunResult out;
  out.has_all_csv_digits = scenario.has_all_csv_digits;
  if (!options.part.is_whole())
    UMOV_TRY(take_part(objects, options.part, monitor.cancel_flag()));
  UMOV_ASSIGN(journal, journal_of(objects, scenario, options, monitor, diagnostics));
  std::size_t with_rows = 0;
  for (std::size_t k = 0; k < objects.size(); ++k) {
    auto outcome = compute(objects[k], objects.size() == 1, {&journal, k}, monitor, diagnostics);
    if (!outcome && objects.size() == 1)
      return tl::unexpected(with_way_on(outcome.error(), journal));
    if (outcome) {
      objects[k].outcome = std::move(*outcome);
      out.stopped = objects[k].outcome.stopped;
    } else {
      out.stopped = outcome.error();
    }
    const bool is_empty = objects[k].outcome.curve.epochs.empty();
    if (scenario.varies_haze && !is_empty && !out.stopped) {
      UMOV_TRY(spread(objects[k], {&journal, k}, monitor, diagnostics));
      out.stopped = objects[k].outcome.stopped;
    }
    with_rows += is_empty ? 0u : 1u;
    if (!is_empty)
      warn_of_accuracy(objects[k].outcome, scenario.light, objects[k].light.floor_i, diagnostics);
    warn_of_bands(objects[k].outcome.curve, diagnostics);
    if (const std::size_t gaps = objects[k].outcome.epochs_in_gaps; gaps > 0)
      diagnostics.warn(fmt::format("{} of the span in gaps of the ephemeris: no rows",
                                   counted(gaps, "epoch") + (gaps > 1 ? " lie" : " lies")));
    if (!is_empty && scenario.earthshine)
      warn_of_earth(objects[k].outcome, *scenario.earthshine, diagnostics);
    if (out.stopped) {
      objects.resize(k + 1);
      break;
    }
    if (is_empty && objects.size() > 1) {
      const auto nothing = nothing_found(objects[k].request);
      diagnostics.warn(nothing ? nothing->message : nothing.error().text());
    }
  }
  if (journal.problem())
    diagnostics.warn(journal.problem()->text());
  if (out.stopped)
    out.stopped = with_way_on(*out.stopped, journal);
  out.journal = std::move(journal);
  if (with_rows == 0) {
    if (out.stopped)
      return tl::unexpected(*out.stopped);
    UMOV_ASSIGN(nothing, nothing_found(objects.front().request));
    return tl::unexpected(nothing);
  }
  std::erase_if(objects, [](const ObjectRun &one) { return one.outcome.curve.epochs.empty(); });
  out.objects = std::move(objects);
  return out;
}

} // namespace umov::jobs
