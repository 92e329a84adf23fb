#include <umov/jobs/observe.h>

#include "jobs/job_journal.h"
#include "jobs/observe_exposures.h"
#include "jobs/observe_frames.h"
#include "jobs/observe_tables.h"
#include "jobs/result_folder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/constants.h>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/instrument/mosaic.h>
#include <umov/instrument/pixel_image.h>
#include <umov/io/index_file.h>
#include <umov/time/earth_orientation.h>

namespace umov::jobs {
namespace {

ObservingConditions conditions_of(const Scenario &scenario, std::uint32_t object) {
  const ScenarioObservation &o = *scenario.observation;
  ObservingConditions out;
  out.air = o.air;
  if (!o.has_own_pressure)
    out.air.pressure_hpa = standard_pressure_hpa(scenario.observer->altitude_m);
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
    std::vector<std::complex<double>> eta;
    if (o.instrument.telescope.port != TelescopePort::Cassegrain) {
      UMOV_ASSIGN(index, find_index(o.instrument.telescope.mirror));
      for (const double nm : band.nm) {
        UMOV_ASSIGN(value, index_at(index, Wavelength::nm(nm)));
        eta.push_back(value);
      }
    }
    UMOV_ASSIGN(one, BandObserver::make(o.instrument, band, conditions, eta));
    out.push_back(std::move(one));
  }
  return out;
}

/// The sampling of a mosaic's image and the edge of its aperture, in figures.
void warn_of_mosaic(const Setup &s, Diagnostics &diagnostics) {
  const ScenarioObservation &o = s.observation;
  if (o.instrument.polarimeter.type != PolarimeterType::Mosaic)
    return;
  for (const BandObserver &observer : s.observers) {
    const double width = observer.fwhm_arcsec(1) / observer.pixel_arcsec();
    if (width < 3)
      diagnostics.warn(fmt::format(
          "{}: a star is {:.2g} px wide at the zenith; under 3 px, summed light of the four "
          "orientations is polarized by where the star stands on its pixels, up to {:.2g} in q. "
          "Defocus, or fit the image of each orientation.",
          observer.band().name, width, -mosaic_alias(width, 0, 0).q)); // on the middle of a pixel
    // Wider images have smoother edges: theirs is less than that of the widest that is summed here.
    constexpr double widest = 16;
    const double taken = std::clamp(width, narrowest_image_px, widest);
    if (o.aperture_fwhm < 2)
      diagnostics.warn(fmt::format(
          "{}: {:g} widths of a star are summed; the edge of an aperture below 2 widths cuts the "
          "four orientations unevenly, up to {:.2g} in q or u. Give observation.aperture_fwhm = 2.",
          observer.band().name, o.aperture_fwhm,
          mosaic_aperture_alias(o.seeing.profile, taken, o.aperture_fwhm * taken)));
  }
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

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

struct Tables {
  CountsTable counts;
  TruthTable truth;
  const FrameSink &take_frame;
};

/// What is told of many frames together.
struct FrameTroubles {
  std::size_t cut = 0, crowded = 0, lost = 0, roomless = 0;
  void add(const Recorded &r) {
    cut += r.frames->is_cut ? 1u : 0u;
    crowded += r.frames->has_star_in_aperture ? 1u : 0u;
    lost += std::ranges::any_of(r.channels, [](const auto &c) { return std::isnan(c.counts); });
    roomless += std::ranges::any_of(
        r.channels, [](const auto &c) { return std::isnan(c.sky) && !std::isnan(c.counts); });
  }
  void warn(Diagnostics &diagnostics) const {
    if (cut > 0)
      diagnostics.warn(fmt::format("{} with an aperture that reaches over the edge: enlarge "
                                   "observation.frame_px, or shorten the trail",
                                   counted(cut, "frame")));
    if (roomless > 0)
      diagnostics.warn(fmt::format("{} without room for the ring that tells the sky: their sky is "
                                   "no number, and umov reduce leaves them out. Enlarge "
                                   "observation.frame_px",
                                   counted(roomless, "frame")));
    if (crowded > 0)
      diagnostics.warn(fmt::format("{} with a star in the aperture that has more than a hundredth "
                                   "of the object's light: it is in the counts",
                                   counted(crowded, "frame")));
    if (lost > 0)
      diagnostics.warn(fmt::format("{} in which the star's image could not be fitted: its counts "
                                   "are no numbers",
                                   counted(lost, "frame")));
  }
};

bool is_glaring(const Recorded &r) {
  double star = 0, sky = 0;
  for (const ChannelCounts &c : r.channels)
    star += c.mean_star, sky += c.mean_sky;
  return sky > 10 * star;
}

Result<void> run_blocks(const Setup &s, const std::vector<Exposure> &exposures,
                        const Monitor &monitor, Tables &tables, Observation &out,
                        Diagnostics &diagnostics) {
  // About 5 kB for each time within an exposure at which the light is computed, and 64 bytes more
  // for each wavelength: 300 MB together.
  const std::size_t wavelengths = s.light.scene().grid.nodes().size();
  const auto &o = s.observation;
  // 12 bytes a pixel while a frame is made: 100 MB together.
  const std::size_t pixels =
      static_cast<std::size_t>(o.frame_px[0]) * static_cast<std::size_t>(o.frame_px[1]);
  const std::size_t most =
      o.makes_frames ? std::clamp<std::size_t>(8'000'000 / pixels, 1, 4096) : 4096;
  const std::size_t times = std::size_t{65'536} * 80 / (80 + wavelengths);
  const std::size_t at_once =
      std::clamp<std::size_t>(times / std::max<std::size_t>(1, s.nodes.size()), 1, most);
  FrameTroubles troubles;
  std::size_t glaring = 0; // exposures in which the sky is far brighter than the object
  for (std::size_t begin = 0; begin < exposures.size(); begin += at_once) {
    if (monitor.is_cancelled())
      return fail(ErrorCode::Interrupted, "stopped; nothing was written");
    const std::span<const Exposure> part(exposures.data() + begin,
                                         std::min(at_once, exposures.size() - begin));
    const auto lit_from = std::chrono::steady_clock::now();
    UMOV_ASSIGN(lit, light_of(s, part, monitor));
    out.light_s += seconds_since(lit_from);
    const auto counted_from = std::chrono::steady_clock::now();
    std::vector<Recorded> recorded(part.size());
    parallel_for(part.size(), s.threads,
                 [&](std::size_t k) { recorded[k] = record(s, part[k], k, lit); });
    for (std::size_t k = 0; k < part.size(); ++k) {
      if (recorded[k].error)
        return tl::unexpected(*recorded[k].error);
      if (recorded[k].frames) {
        troubles.add(recorded[k]);
        ++out.frames;
        if (tables.take_frame)
          UMOV_TRY(tables.take_frame(
              frame_name(s.observers.front().conditions().object, part[k].planned.plan.index),
              fits_of(s, part[k], recorded[k])));
        recorded[k].frames.reset();
      }
      tables.counts.add(part[k], recorded[k]);
      tables.truth.add(part[k], recorded[k]);
      glaring += is_glaring(recorded[k]) ? 1u : 0u;
      const bool is_full =
          std::ranges::any_of(recorded[k].channels, [](const auto &c) { return c.is_saturated; });
      out.saturated += is_full ? 1u : 0u;
    }
    out.counts_s += seconds_since(counted_from);
    out.exposures += part.size();
    monitor.advance("exposures", begin + part.size(), exposures.size());
  }
  troubles.warn(diagnostics);
  if (glaring > 0)
    diagnostics.warn(
        fmt::format("{} with a sky more than ten times as bright as the object in the "
                    "aperture: an error of one per cent of it is a tenth of the object",
                    counted(glaring, "exposure")));
  return {};
}

/// What the instrument and the site say that can hardly be meant.
void warn_of_setup(const Setup &s, double site_height_m, Diagnostics &diagnostics) {
  const Detector &d = s.observation.instrument.detector;
  // The bias takes a little of it; a well that is a few per cent over is every maker's choice.
  const double numbers = std::exp2(d.bits) * d.gain_e_adu;
  const bool has_numbers = d.model != DetectorModel::Ideal && d.model != DetectorModel::Counter;
  if (has_numbers && d.em_gain <= 1 && d.well_e > numbers)
    diagnostics.warn(
        fmt::format("detector: a well of {:g} e is more than bits = {} with {:g} e/ADU "
                    "tell ({:g} e): numbers fill first",
                    d.well_e, d.bits, d.gain_e_adu, numbers));
  if (constexpr double highest = 9000; site_height_m > highest)
    diagnostics.warn(fmt::format("observer.alt_m = {:g}: higher than any mountain. It is in metres",
                                 site_height_m));
}

Result<void> observe_object(const Scenario &scenario, const ObservedBands &bands,
                            const Programme &programme, std::uint32_t object,
                            const JobOptions &options, const Monitor &monitor,
                            const FrameSink &take_frame, Observation &out,
                            Diagnostics &diagnostics) {
  UMOV_ASSIGN(loaded,
              load_object(scenario, object,
                          {options.allow_bad_checksum, options.allow_old_elements}, diagnostics));
  LightCurveRequest request =
      light_curve_request(scenario, scenario.objects[object], loaded, options);
  out.inputs.insert(out.inputs.end(), loaded.inputs.begin(), loaded.inputs.end());
  UMOV_ASSIGN(track, Track::make(request.track));
  UMOV_ASSIGN(taken, exposures_of(scenario, track, request, programme, object, monitor));
  const std::vector<Exposure> &exposures = taken.exposures;
  const std::size_t all = exposures.size() + taken.left_out.sum();
  if (const auto told = tell_left_out(taken.left_out, all, scenario, request.object, diagnostics);
      !told.empty())
    out.left_out.push_back(told);
  if (exposures.empty())
    return {};
  const auto began = std::chrono::steady_clock::now();
  UMOV_ASSIGN(models, make_light_models(request, loaded.scene));
  const ObservingConditions conditions = conditions_of(scenario, object);
  UMOV_ASSIGN(observers, observers_of(*scenario.observation, bands, loaded.scene.grid, conditions));
  for (const Exposure &e : exposures)
    if (!observers[e.planned.band].is_prepared(e.planned.plan.state))
      UMOV_TRY(observers[e.planned.band].prepare(e.planned.plan.state));
  UMOV_ASSIGN(stars, field_of(*scenario.observation, out.inputs));
  PixelImages images(scenario.observation->seeing.profile);
  const double width = observers.front().fwhm_arcsec(1);
  const Setup setup{
      scenario,
      *scenario.observation,
      loaded.scene.grid.terms(),
      *models.light,
      track,
      std::move(observers),
      bands.zero_flux,
      exposure_nodes(scenario.observation->exposure_s,
                     shorter(shortest_feature_s(track, exposures),
                             trail_feature_s(*scenario.observation, track, exposures, width))),
      request.object,
      {conditions.air.pressure_hpa, 283.15, 4},
      {scenario.observation->sky, conditions.air, bands.v},
      std::move(stars),
      images,
      options.threads};
  out.light_s += seconds_since(began);
  warn_of_mosaic(setup, diagnostics);
  UMOV_TRY(check_air(exposures, setup, diagnostics));
  warn_of_setup(setup, scenario.observer->altitude_m, diagnostics);
  Tables tables{CountsTable(setup), TruthTable(setup), take_frame};
  UMOV_TRY(run_blocks(setup, exposures, monitor, tables, out, diagnostics));
  out.counts.append(std::move(tables.counts).table());
  out.truth.append(std::move(tables.truth).table());
  const LightFacts &facts = models.light->facts();
  out.light.push_back({request.object, name_of(facts.method), facts.visibility,
                       models.light->instruction_set(), models.device()});
  tell_of_device(models.device(), diagnostics);
  return models.keep_masks();
}

} // namespace

Result<Observation> observe(const Scenario &given, const JobOptions &options,
                            const Monitor &monitor, Diagnostics &diagnostics,
                            const FrameSink &take_frame) {
  UMOV_TRY(check_complete_for_run(given));
  if (!given.observation)
    return fail(ErrorCode::BadInput,
                "umov observe also needs [observation] and an instrument: add instrument = "
                "\"c11_imx250\" (umov instrument list has others) and [observation] exposure_s",
                {given.file});
  UMOV_ASSIGN(bands, observed_bands(given));
  UMOV_ASSIGN(programme, Programme::make(given, bands.responses, diagnostics));
  Scenario scenario = given;
  scenario.bands = bands.bands;
  warn_if_beyond_leap_seconds(scenario.time->stop, diagnostics);
  warn_if_outside_eop(scenario.time->start, scenario.time->stop, diagnostics);
  Observation out;
  for (std::size_t k = 0; k < scenario.objects.size(); ++k)
    UMOV_TRY(observe_object(scenario, bands, programme, static_cast<std::uint32_t>(k), options,
                            monitor, take_frame, out, diagnostics));
  if (out.exposures == 0)
    return fail(ErrorCode::Nothing,
                fmt::format("no exposure falls in a pass; umov passes tells when there is one{}{}",
                            out.left_out.empty() ? "" : ". ", fmt::join(out.left_out, "; ")),
                scenario.place("time.start"));
  if (out.saturated == out.exposures)
    return fail(ErrorCode::Physics,
                fmt::format("every exposure of {} is saturated. Shorten observation.exposure_s = "
                            "{}, or defocus (atmosphere.seeing.arcsec)",
                            out.exposures, scenario.observation->exposure_s),
                scenario.place("observation.exposure_s"));
  if (out.saturated > 0)
    diagnostics.warn(fmt::format("{} of {} exposures are saturated", out.saturated, out.exposures));
  note_observation(out.counts, scenario, bands);
  note_observation(out.truth, scenario, bands);
  note_warnings(out.counts, diagnostics);
  return out;
}

} // namespace umov::jobs
