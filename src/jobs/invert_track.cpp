#include <umov/jobs/invert.h>

#include "jobs/invert_between.h"
#include "jobs/invert_light.h"
#include "jobs/track_tables.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/median.h>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <umov/inverse/sample_errors.h>

namespace umov::jobs {
namespace {

/// As state.json tells it, to the digits that it has: a tracking that goes on has the same steps.
Epoch<Utc> told(Epoch<Utc> time) {
  const auto read = utc_from_iso(to_iso_exact(time));
  return read ? *read : time;
}

/// Epochs [first, first + count) of a light curve.
ObservedLightCurve part_of(const ObservedLightCurve &all, std::size_t first, std::size_t count) {
  ObservedLightCurve out = all;
  const auto cut = [&](auto &rows) {
    rows = {rows.begin() + static_cast<std::ptrdiff_t>(first),
            rows.begin() + static_cast<std::ptrdiff_t>(first + count)};
  };
  cut(out.curve.epochs);
  cut(out.geometry);
  const double begin = out.curve.epochs.empty() ? 0 : out.curve.epochs.front().seconds;
  for (ObservedEpoch &epoch : out.curve.epochs)
    epoch.seconds -= begin;
  const auto keep = [&](auto &rows) {
    std::erase_if(rows,
                  [&](const auto &row) { return row.epoch < first || row.epoch >= first + count; });
    for (auto &row : rows)
      row.epoch -= first;
  };
  keep(out.curve.samples);
  keep(out.curve.counts);
  return out;
}

/// One epoch in the bands of the scenario. Rows stand in order of epochs.
ObservedCurve epoch_of(const ObservedLightCurve &all, std::size_t epoch,
                       const std::vector<std::string> &bands) {
  ObservedCurve out;
  out.bands = bands;
  out.is_absolute = all.curve.is_absolute;
  out.epochs = {all.curve.epochs[epoch]};
  out.epochs.front().seconds = 0;
  const auto take = [&](const auto &rows, auto &to) {
    const auto of = [](const auto &row) { return row.epoch; };
    const auto end = std::ranges::upper_bound(rows, epoch, {}, of);
    for (auto row = std::ranges::lower_bound(rows, epoch, {}, of); row != end; ++row) {
      to.push_back(*row);
      to.back().epoch = 0;
      to.back().band = all.column[row->band];
    }
  };
  take(all.curve.samples, out.samples);
  take(all.curve.counts, out.counts);
  return out;
}

void tell(const TrackStep &step, const std::string &time, TrackHistory &out) {
  constexpr std::size_t few = 20;
  if (step.spread > 0)
    out.events.push_back(
        fmt::format("{}: wide modes were spread over {}", time, counted(step.spread, "place")));
  if (step.dropped.size() > few)
    out.events.push_back(fmt::format("{}: {} modes fell away", time, step.dropped.size()));
  for (const std::size_t number : step.dropped)
    if (step.dropped.size() <= few)
      out.events.push_back(fmt::format("{}: mode {} fell below e^-20 of the best", time, number));
  for (const auto &[one, other] : step.joined)
    out.events.push_back(fmt::format("{}: mode {} became one with mode {}", time, one, other));
}

/// A bank on its way through the epochs of a light curve.
struct Following {
  TrackHistory history;
  EndMember fitted; ///< [epoch * bands + band] of the light curve's own bands
};

/// What the heaviest filter makes of an epoch, in the units of what was measured.
void put_light(const TrackStep &step, const TrackMode &heaviest, const TrackFrame &frame,
               const ObservedLightCurve &observed, EndMember &out) {
  for (const std::size_t column : observed.column) {
    const double gain = heaviest.nuisances[frame.errors.has_clouds ? 0 : column];
    const auto put = [&](const std::vector<double> &light, std::vector<double> &to) {
      to.push_back(light.empty() ? std::nan("") : gain * light[column]);
    };
    put(step.i, out.i);
    put(step.q, out.q);
    put(step.u, out.u);
  }
}

Result<Following> follow(AttitudeBank &bank, const ObservedLightCurve &observed,
                         const TrackFrame &frame, TrackStart &now, const Monitor &monitor) {
  Following out;
  for (std::size_t e = 0; e < observed.geometry.size(); ++e) {
    monitor.advance("epochs", e, observed.geometry.size());
    const Epoch<Utc> time = told(observed.geometry[e].time);
    const auto began = std::chrono::steady_clock::now();
    UMOV_ASSIGN(step,
                bank.step(epoch_of(observed, e, frame.bands), seconds_between(time, now.time)));
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - began;
    out.history.step_ms.push_back(took.count());
    now.time = time;
    now.modes = bank.modes();
    const bool is_first_miss = now.memory.misses == 0 && bank.memory().misses > 0;
    now.memory = bank.memory();
    const std::string utc = to_iso_exact(time);
    for (std::size_t k = 0; k < now.modes.size(); ++k)
      out.history.rows.push_back({utc, now.modes[k], step.chi2[k], step.measurements});
    tell(step, to_iso(time), out.history);
    put_light(step, now.modes.front(), frame, observed, out.fitted);
    out.history.poses_lit += step.poses_lit;
    ++out.history.epochs;
    if (is_first_miss)
      now.missed_utc = to_iso(time);
    else if (now.memory.misses == 0)
      now.missed_utc.clear();
    if (bank.loss() == TrackLoss::None)
      continue;
    out.history.loss = bank.loss();
    out.history.lost_utc = bank.loss() == TrackLoss::Misfit ? now.missed_utc : to_iso(time);
    break;
  }
  const double scale = scale_of(now.modes.front(), frame);
  for (auto *light : {&out.fitted.i, &out.fitted.q, &out.fitted.u})
    for (double &value : *light)
      value /= scale;
  return out;
}

/// The modes as they were at second 0 of a curve that ends now.
PoseAnswer at_begin(PoseAnswer answer, const ObservedCurve &curve) {
  for (PoseMode &mode : answer.modes)
    mode.turning.attitude = attitude_at(mode.turning, -curve.epochs.back().seconds);
  return answer;
}

/// modes.ecsv, in the form of umov invert spin, at the last epoch.
Table last_modes(const PoseAnswer &answer, const TrackStart &now, const TrackFrame &frame,
                 Verdict verdict) {
  Table out = modes_table(answer, true);
  const std::string time = to_iso_exact(now.time);
  out.note(epoch_note, time);
  out.note(until_note, time);
  out.note(median_note, fmt::format("{}", now.median_i));
  out.note(floor_note, fmt::format("{}", now.floor));
  out.note(verdict_note, searched_by(now, verdict));
  out.note(mesh_note, frame.body.mesh);
  out.note(materials_note, frame.body.materials);
  out.note(unit_note, unit_of_light(frame.is_absolute));
  return out;
}

/// Rows that the start has learnt from; BadInput if there are no others.
Result<std::size_t> rows_until(const Epoch<Utc> &time, const ObservedLightCurve &observed,
                               const std::string &file) {
  const auto &geometry = observed.geometry;
  std::size_t out = 0;
  while (out < geometry.size() && seconds_between(told(geometry[out].time), time) <= 0)
    ++out;
  if (out == geometry.size())
    return fail(ErrorCode::BadInput,
                fmt::format("no observation is later than {}, up to which the start has its own "
                            "data; later ones are what is followed",
                            to_iso(time)),
                {file});
  return out;
}

/// Median light of each mode that a start has, over all epochs, as if it did not turn; of those
/// that have any.
Result<LightRange> expected_light(const CurveModel &model, const std::vector<TrackMode> &modes,
                                  const TrackFrame &frame, unsigned threads) {
  std::vector<Turning> turnings;
  turnings.reserve(modes.size());
  for (const TrackMode &mode : modes)
    turnings.push_back({mode.turning.attitude, {}});
  std::vector<double> each(modes.size());
  const bool is_lit =
      model.for_each(turnings, {}, threads, [&](std::size_t k, const ModelLight &light) {
        each[k] = scale_of(modes[k], frame) * median_of({light.i.begin(), light.i.end()});
      });
  if (!is_lit)
    return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
  std::erase_if(each, [](double light) { return !(light > 0); });
  if (each.empty())
    return LightRange{};
  return LightRange{std::ranges::min(each), std::ranges::max(each)};
}

} // namespace

Result<Inversion> invert_track(const Scenario &scenario, const InvertRequest &request,
                               const TrackRequest &track, const JobOptions &options,
                               const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_ASSIGN(start, open_track_start(track.start));
  UMOV_ASSIGN(ready, prepare(scenario, request, options, diagnostics, monitor.cancel));
  take_apart(ready, request, options, diagnostics, monitor.cancel);
  TrackFrame frame{{},
                   parts_of(ready),
                   request.errors,
                   ready.observed.curve.is_absolute,
                   body_words(ready.light.model().scene())};
  for (const Band &band : scenario.bands)
    frame.bands.push_back(band.name);
  UMOV_ASSIGN(now, read_track_start(start, frame, track.rate_sd * rad_per_deg, diagnostics));
  frame.errors.median_i = now.median_i;
  frame.errors.floor = now.floor = std::max(request.errors.floor, now.floor);
  UMOV_ASSIGN(before, rows_until(now.time, ready.observed, request.observations.front()));
  ObservedLightCurve observed =
      part_of(ready.observed, before, ready.observed.geometry.size() - before);
  const bool is_quick = request.method == LightMethod::Masks;
  const auto light = is_quick ? followed_lighting(ready, options.threads, monitor)
                              : searched_lighting(ready, options.threads, monitor);
  UMOV_TRY(check_brightness(start, frame, now.median_i, inverse::median_of_i(observed.curve), [&] {
    return expected_light({observed.curve, light, observed.column, frame.parts}, now.modes, frame,
                          options.threads);
  }));
  AttitudeBank bank(now.modes, light, frame.bands, frame.parts,
                    {frame.errors, track.rate_noise * rad_per_deg, options.threads});
  bank.set_memory(now.memory);
  UMOV_ASSIGN(found, follow(bank, observed, frame, now, monitor));
  found.history.before = before;
  observed = part_of(observed, 0, found.history.epochs);
  keep_masks(ready);
  const PoseAnswer answer = answer_of(now, frame);
  const auto direct = lighting_of(ready.light, options.threads, monitor);
  const auto symmetries = find_symmetries(direct, scenario.seed);
  Judgement judgement =
      judge_track(now, frame, found.history, answer, observed.curve, found.fitted, symmetries);
  UMOV_TRY(judge_direct_light(scenario, request, ready, observed.curve,
                              at_begin(answer, observed.curve), options, monitor, judgement));
  Inversion out;
  out.verdict = judgement.verdict;
  out.summary = track_summary(now, found.history, answer, judgement);
  out.json = track_json(now, found.history, answer, judgement, symmetries);
  out.state = state_json(now, frame, found.history.loss, out.verdict);
  out.tables = {{"modes", last_modes(answer, now, frame, out.verdict)},
                {"track", track_table(found.history, frame)},
                {"fit", fit_table(observed, found.fitted, frame.errors)}};
  out.page = track_page("Followed: " + scenario.title, out.tables[2].table, out.tables[1].table,
                        out.summary);
  out.inputs = observed.inputs;
  out.inputs.insert(out.inputs.end(), now.inputs.begin(), now.inputs.end());
  out.seed = scenario.seed;
  out.light = light_used(ready, scenario, diagnostics);
  monitor.tell(fmt::format("{} poses lit; an epoch took {:.1f} ms in the median, {:.1f} at most",
                           found.history.poses_lit, median_of(found.history.step_ms),
                           std::ranges::max(found.history.step_ms)));
  return out;
}

} // namespace umov::jobs
