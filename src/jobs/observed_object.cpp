#include "jobs/observed_object.h"

#include "jobs/observe_frames.h"
#include "jobs/observe_warnings.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/constants.h>
#include <umov/core/parallel.h>
#include <umov/instrument/pixel_image.h>

namespace umov::jobs {
namespace {

ObservingConditions conditions_of(const Scenario &scenario, std::uint32_t object) {
  const ScenarioObservation &o = *scenario.observation;
  ObservingConditions out;
  out.air = air_over(o.air, *scenario.observer);
  out.seeing = o.seeing;
  if (o.scintillation_c_y)
    out.scintillation = ScintillationSite{scenario.observer->altitude_m, *o.scintillation_c_y};
  out.has_slewing_factor = o.has_slewing_factor;
  out.aperture_fwhm = o.aperture_fwhm;
  out.seed = scenario.seed;
  out.object = object;
  return out;
}

/// Each band at the wavelengths of the scene's grid: they stand closer where its colours ask for
/// it.
Result<std::vector<BandObserver>> observers_of(const ScenarioObservation &o,
                                               const ObservedBands &bands, const BandGrid &grid,
                                               const ObservingConditions &conditions) {
  std::vector<BandObserver> out;
  for (std::size_t b = 0; b < bands.responses.size(); ++b) {
    const BandResponse band = at_nodes(bands.responses[b], grid, b);
    UMOV_ASSIGN(eta, port_metals(o.instrument.telescope, band.nm));
    UMOV_ASSIGN(one, BandObserver::make(o.instrument, band, conditions, eta));
    out.push_back(std::move(one));
  }
  return out;
}

/// Times in which the light may change most: a flat mirror's flash lasts as long as the Sun's disk,
/// seen by the half vector, takes to pass.
double shortest_feature_s(const Track &track, const std::vector<Exposure> &exposures) {
  constexpr double disk_rad = sun_radius_at_1au_rad;
  std::vector<ObservingGeometry> samples;
  const std::size_t step = std::max<std::size_t>(1, exposures.size() / 200);
  for (std::size_t k = 0; k < exposures.size(); k += step)
    samples.push_back(exposures[k].middle);
  const double rate = track.half_vector_rate(samples);
  return rate > 0 ? disk_rad / rate : 0;
}

/// Of two times, where 0 is none.
double shorter(double a, double b) { return a > 0 && b > 0 ? std::min(a, b) : std::max(a, b); }

constexpr const char *stopped = "stopped; nothing was written";

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

} // namespace

/// What is known when the exposures are: the setup refers to its neighbours, so it stays in place.
struct ObservedObject::Ready {
  Ready(Track where, ImageProfile profile) : track(std::move(where)), images(profile) {}
  Track track;
  std::vector<Exposure> exposures;
  std::string left_out;
  PixelImages images;
  std::optional<Setup> setup;
  LightModels models;
};

void ObservedObject::Forget::operator()(Ready *ready) const { delete ready; }

ObservedObject::ObservedObject(const ObservationPlan &plan, std::uint32_t number,
                               LoadedObject loaded)
    : plan_(&plan), number_(number), loaded_(std::move(loaded)),
      request_(
          light_curve_request(plan.scenario, plan.scenario.objects[number], loaded_, plan.options)),
      inputs_(loaded_.inputs) {}

Result<ObservedObject> ObservedObject::load(const ObservationPlan &plan, std::uint32_t number,
                                            const Monitor &monitor, Diagnostics &diagnostics) {
  const JobOptions &options = plan.options;
  UMOV_ASSIGN(loaded, load_object(plan.scenario, number,
                                  {.allow_bad_checksum = options.allow_bad_checksum,
                                   .allow_old_elements = options.allow_old_elements,
                                   .cancel = monitor.cancel},
                                  diagnostics));
  ObservedObject out(plan, number, std::move(loaded));
  UMOV_ASSIGN(stars, field_of(*plan.scenario.observation, out.inputs_, diagnostics));
  out.stars_ = std::move(stars);
  return std::move(out);
}

Result<void> ObservedObject::prepare(const Monitor &monitor, Diagnostics &diagnostics) {
  if (ready_)
    return {};
  const Scenario &scenario = plan_->scenario;
  UMOV_ASSIGN(track, Track::make(request_.track));
  UMOV_ASSIGN(taken, exposures_of(scenario, track, request_, plan_->programme, number_, monitor));
  const std::size_t all = taken.exposures.size() + taken.left_out.sum();
  std::unique_ptr<Ready, Forget> made(
      new Ready(std::move(track), scenario.observation->seeing.profile));
  made->exposures = std::move(taken.exposures);
  made->left_out = tell_left_out(taken.left_out, all, scenario, request_.object, diagnostics);
  ready_ = std::move(made);
  return ready_->exposures.empty() ? Result<void>() : set_up(diagnostics);
}

Result<void> ObservedObject::set_up(Diagnostics &diagnostics) {
  const Scenario &scenario = plan_->scenario;
  const ScenarioObservation &o = *scenario.observation;
  const ObservingConditions conditions = conditions_of(scenario, number_);
  UMOV_ASSIGN(observers, observers_of(o, plan_->bands, loaded_.scene.grid, conditions));
  const double width = observers.front().fwhm_arcsec(1);
  const std::vector<Exposure> &exposures = ready_->exposures;
  ready_->setup.emplace(Setup{
      scenario,
      o,
      loaded_.scene.grid.terms(),
      ready_->track,
      std::move(observers),
      plan_->bands.zero_flux,
      exposure_nodes(o.exposure_s, shorter(shortest_feature_s(ready_->track, exposures),
                                           trail_feature_s(o, ready_->track, exposures, width))),
      request_.object,
      {conditions.air.pressure_hpa, 283.15, std::min(4., conditions.air.pressure_hpa)},
      {o.sky, conditions.air, plan_->bands.v},
      stars_,
      ready_->images,
      plan_->options.threads});
  warn_of_mosaic(*ready_->setup, diagnostics);
  UMOV_TRY(check_air(exposures, *ready_->setup, diagnostics));
  warn_of_trails(*ready_->setup, exposures, diagnostics);
  warn_of_setup(*ready_->setup, diagnostics);
  return {};
}

std::size_t ObservedObject::exposures() const { return ready_->exposures.size(); }
std::size_t ObservedObject::nodes() const {
  return ready_->setup ? ready_->setup->nodes.size() : 1;
}
const std::string &ObservedObject::left_out() const { return ready_->left_out; }
const LightModels *ObservedObject::light() const {
  return ready_ && ready_->models.light ? &ready_->models : nullptr;
}
Result<void> ObservedObject::keep_masks() const {
  return light() != nullptr ? light()->keep_masks() : Result<void>();
}

/// Light and channels, before the first exposure.
Result<void> ObservedObject::make_ready(const Monitor &monitor) {
  if (ready_->models.light)
    return {};
  std::vector<BandObserver> &observers = ready_->setup->observers;
  for (const Exposure &e : ready_->exposures)
    if (!observers[e.planned.band].is_prepared(e.planned.plan.state))
      UMOV_TRY(observers[e.planned.band].prepare(e.planned.plan.state));
  UMOV_ASSIGN(models, make_light_models(request_, loaded_.scene, monitor.cancel));
  ready_->models = std::move(models);
  return {};
}

std::size_t exposures_with_shared_paths(std::size_t nodes) {
  constexpr std::size_t poses = 256; // as in the blocks of a light curve
  return std::max<std::size_t>(1, poses / std::max<std::size_t>(1, nodes));
}

/// How many exposures are recorded at once.
std::size_t ObservedObject::block() const {
  if (plan_->scenario.light.bounces > 1)
    return exposures_with_shared_paths(nodes());
  // About 5 kB for each time within an exposure at which the light is computed, and 64 bytes more
  // for each wavelength: 300 MB together.
  const std::size_t wavelengths = loaded_.scene.grid.nodes().size();
  const ScenarioObservation &o = *plan_->scenario.observation;
  // 12 bytes a pixel while a frame is made: 100 MB together.
  const std::size_t pixels =
      static_cast<std::size_t>(o.frame_px[0]) * static_cast<std::size_t>(o.frame_px[1]);
  const std::size_t most =
      o.makes_frames ? std::clamp<std::size_t>(8'000'000 / pixels, 1, 4096) : 4096;
  const std::size_t times = std::size_t{65'536} * 80 / (80 + wavelengths);
  return std::clamp<std::size_t>(times / std::max<std::size_t>(1, nodes()), 1, most);
}

Result<void> ObservedObject::record(IndexRange range, const Monitor &monitor, RecordedSink &sink) {
  const auto began = std::chrono::steady_clock::now();
  UMOV_TRY(make_ready(monitor));
  sink.light_s += seconds_since(began);
  const std::size_t length = block();
  // Light that touches several surfaces shares its paths within a block, which is then lit whole.
  const bool shares_paths = plan_->scenario.light.bounces > 1;
  std::size_t done = 0;
  for (std::size_t at = range.first; at < range.end(); at = range.first + done) {
    if (monitor.is_cancelled())
      return fail(ErrorCode::Interrupted, stopped);
    const std::size_t first = shares_paths ? at / length * length : at;
    const std::size_t behind = std::min(range.end(), first + length);
    const std::size_t lit_behind =
        shares_paths ? std::min(ready_->exposures.size(), first + length) : behind;
    UMOV_TRY(record_block({first, lit_behind - first}, {at, behind - at}, monitor, sink));
    done += behind - at;
    monitor.advance("exposures", done, range.count);
  }
  return {};
}

/// Lights a block, and records what is wanted of it.
Result<void> ObservedObject::record_block(IndexRange block, IndexRange wanted,
                                          const Monitor &monitor, RecordedSink &sink) {
  const Setup &s = *ready_->setup;
  const auto lit_from = std::chrono::steady_clock::now();
  const std::span<const Exposure> part(ready_->exposures.data() + block.first, block.count);
  UMOV_ASSIGN(lit, light_of(s, *ready_->models.light, part, monitor));
  sink.light_s += seconds_since(lit_from);
  const auto counted_from = std::chrono::steady_clock::now();
  const std::size_t before = wanted.first - block.first;
  std::vector<Recorded> recorded(wanted.count);
  parallel_for(wanted.count, s.threads, [&](std::size_t k) {
    if (!monitor.is_cancelled())
      recorded[k] = jobs::record(s, part[before + k], before + k, lit);
  });
  if (monitor.is_cancelled())
    return fail(ErrorCode::Interrupted, stopped);
  CountsTable counts(s);
  TruthTable truth(s);
  for (std::size_t k = 0; k < wanted.count; ++k) {
    const Exposure &e = part[before + k];
    if (recorded[k].error)
      return tl::unexpected(*recorded[k].error);
    sink.tally.add(recorded[k]);
    if (recorded[k].frames) {
      ++sink.frames;
      if (sink.take_frame)
        UMOV_TRY(
            sink.take_frame(frame_name(number_, e.planned.plan.index), fits_of(s, e, recorded[k])));
      recorded[k].frames.reset();
    }
    counts.add(e, recorded[k]);
    truth.add(e, recorded[k]);
  }
  UMOV_TRY(sink.take_rows(std::move(counts).table(), std::move(truth).table()));
  sink.exposures += wanted.count;
  sink.counts_s += seconds_since(counted_from);
  return {};
}

} // namespace umov::jobs
