#include <umov/jobs/observe.h>

#include "jobs/observe_plan.h"
#include "jobs/observe_sky.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <umov/atmosphere/refraction.h>
#include <umov/core/constants.h>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/frames/sky.h>
#include <umov/instrument/exposure.h>
#include <umov/instrument/mosaic.h>
#include <umov/io/index_file.h>
#include <umov/lightcurve/derived_errors.h>
#include <umov/photometry/radiometry.h>
#include <umov/time/earth_orientation.h>

namespace umov::jobs {
namespace {

/// What an exposure is made of, before anything is computed.
struct Exposure {
  PlannedExposure planned;
  ObservingGeometry middle;
  Epoch<Utc> stamp; ///< as the clock of the telescope says
  double cloud = 1;
};

/// Everything of one object that does not change from exposure to exposure.
struct Setup {
  const Scenario &scenario;
  const ScenarioObservation &observation;
  const ObservedBands &bands;
  const LightModel &light;
  const Track &track;
  std::vector<BandObserver> observers; ///< per band
  std::vector<ExposureNode> nodes;
  std::string object;
  SurfaceAir surface;
  double k_v = 0; ///< extinction in V
  unsigned threads = 0;
};

/// One exposure, finished.
struct Recorded {
  std::vector<ChannelCounts> channels;
  Stokes<SkyNorth> truth; ///< in the frame of the files [W m-2 nm-1]
  Angle axis;             ///< of the instrument's x axis in that frame
  double airmass = 0, k_mag = 0, rate_rad_s = 0;
  bool is_twilight_unknown = false;
  std::optional<Error> error;
};

/// Position angle of the zenith in the frame of the files.
Angle zenith_in(PolarizationFrame frame, const ObservingGeometry &g) {
  switch (frame) {
  case PolarizationFrame::Equatorial:
    return position_angle(g.zenith - g.to_observer * dot(g.zenith, g.to_observer), {0, 0, 1},
                          g.to_observer);
  case PolarizationFrame::Scattering:
    return Angle::radians(-g.pa_scat_altaz.radians());
  case PolarizationFrame::AltAz:
    break;
  }
  return {};
}

Angle parallactic_angle(const ObservingGeometry &g) {
  return zenith_in(PolarizationFrame::Equatorial, g);
}

Angle x_axis_from_zenith(const Instrument &instrument, const ObservingGeometry &g) {
  return axis_from_zenith(instrument.telescope, Angle::degrees(instrument.polarimeter.x_axis_deg),
                          parallactic_angle(g));
}

/// The light of all nodes of some exposures.
struct LitBlock {
  std::vector<TrackPoint> points; ///< [exposure * nodes + node]
  StokesTable table;
};

Result<LitBlock> light_of(const Setup &s, std::span<const Exposure> exposures) {
  const std::size_t per = s.nodes.size();
  std::vector<std::optional<Result<TrackPoint>>> placed(exposures.size() * per);
  parallel_for(exposures.size(), s.threads, [&](std::size_t e) {
    for (std::size_t n = 0; n < per; ++n)
      placed[e * per + n] = s.track.at(plus_seconds(exposures[e].middle.time, s.nodes[n].offset_s));
  });
  LitBlock out;
  std::vector<Pose> poses;
  std::vector<double> angles;
  for (auto &one : placed) {
    if (!*one)
      return tl::unexpected(one->error());
    out.points.push_back(std::move(**one));
    const TrackPoint &point = out.points.back();
    poses.push_back(point.pose);
    angles.insert(angles.end(), point.joint_angles_rad.begin(), point.joint_angles_rad.end());
  }
  LightTask task;
  task.threads = s.threads;
  if (!s.light.evaluate(poses, angles, out.table, task))
    return fail(ErrorCode::Interrupted, "stopped");
  return out;
}

/// Light of one node of an exposure and a band, in the scattering plane, as irradiance at the site
/// with the Sun's spectrum replaced by its mean in the band.
Stokes<ScatteringPlane> irradiance_of(const BandResult &lit, const BandResponse &band,
                                      const ObservingGeometry &g) {
  return lit.stokes *
         irradiance_at_observer(1, band.solar_mean, g.sun_distance_km, g.sunlit, g.range_km);
}

ExposureLight arriving(const Setup &s, const Exposure &e, std::size_t number, const LitBlock &lit,
                       Recorded &out) {
  const BandObserver &observer = s.observers[e.planned.band];
  const BandResponse &band = observer.band();
  const ObservingGeometry &g = e.middle;
  ExposureLight light;
  light.flux.resize(band.nm.size());
  for (std::size_t n = 0; n < s.nodes.size(); ++n) {
    const std::size_t at = number * s.nodes.size() + n;
    const ObservingGeometry &now = lit.points[at].geometry;
    const Angle x_axis = x_axis_from_zenith(s.observation.instrument, now);
    const Angle to_file =
        Angle::radians(-now.pa_scat_altaz.radians() - zenith_in(s.scenario.frame, now).radians());
    for (std::size_t k = 0; k < band.nm.size(); ++k) {
      const auto light_here =
          irradiance_of(lit.table.at(at, s.bands.index[e.planned.band][k]), band, now);
      const auto zenith_axes =
          rotate_to<SkyNorth>(light_here, Angle::radians(-now.pa_scat_altaz.radians()));
      light.flux[k] +=
          observer.at_polarimeter(k, zenith_axes, now.altitude, x_axis) * s.nodes[n].weight;
      out.truth += rotate_to<SkyNorth>(light_here, to_file) * (band.weight[k] * s.nodes[n].weight);
    }
  }
  const auto sky = sky_light(s.observation.sky, band, g, s.k_v);
  out.is_twilight_unknown = sky.is_outside_fit;
  light.sky = sky.per_arcsec2;
  light.altitude = g.altitude;
  const Angle seen = apparent_altitude(band.pivot_nm, g.altitude, s.surface);
  light.airmass = airmass(seen);
  light.axis_zenith = x_axis_from_zenith(s.observation.instrument, g);
  light.axis =
      Angle::radians(light.axis_zenith.radians() + zenith_in(s.scenario.frame, g).radians());
  light.transparency = e.cloud;
  const auto &first = lit.points[number * s.nodes.size()].geometry;
  const auto &last = lit.points[(number + 1) * s.nodes.size() - 1].geometry;
  light.rate_rad_s = angle_between(first.to_observer, last.to_observer) /
                     std::max(1e-9, s.nodes.back().offset_s - s.nodes.front().offset_s);
  return light;
}

Recorded record(const Setup &s, const Exposure &e, std::size_t number, const LitBlock &lit) {
  Recorded out;
  const BandObserver &observer = s.observers[e.planned.band];
  const ExposureLight light = arriving(s, e, number, lit, out);
  out.axis = light.axis;
  out.airmass = light.airmass;
  out.rate_rad_s = light.rate_rad_s;
  out.k_mag = -2.5 * std::log10(observer.mean_transmission(light.airmass)) / light.airmass;
  auto counts = observer.observe(e.planned.plan, light);
  if (counts)
    out.channels = std::move(*counts);
  else
    out.error = counts.error();
  return out;
}

/// Transparency that wanders: an Ornstein-Uhlenbeck process in magnitudes.
class Cloud {
public:
  Cloud(const ScenarioObservation &o, std::uint64_t seed, std::uint32_t object)
      : sd_(o.cloud_sd_mag), time_(o.cloud_time_s), draws_({seed, object, 0, 0, 0xc10d}) {}
  double next(double elapsed_s) {
    if (!(sd_ > 0))
      return 1;
    const double kept = std::exp(-elapsed_s / time_);
    mag_ = mag_ * kept + sd_ * std::sqrt(1 - kept * kept) * draws_.normal();
    return std::pow(10, -0.4 * mag_);
  }

private:
  double sd_, time_, mag_ = 0;
  Draws draws_;
};

/// Columns of the counts, filled exposure by exposure.
class CountsTable {
public:
  explicit CountsTable(const Setup &s) : s_(s) {}

  void add(const Exposure &e, const Recorded &r) {
    for (const ChannelCounts &c : r.channels) {
      time_.push_back(to_iso(e.stamp));
      exposure_.push_back(e.planned.plan.index);
      set_.push_back(static_cast<std::int64_t>(e.planned.set));
      name_.push_back(s_.object);
      band_.push_back(s_.observers[e.planned.band].band().name);
      channel_.push_back(c.channel);
      saturated_.push_back(c.is_saturated);
      const double axis = std::fmod(std::fmod(r.axis.degrees(), 180) + 180, 180);
      const double values[] = {c.analyser_deg,
                               e.planned.plan.state.plate_deg,
                               axis,
                               c.counts,
                               c.counts / s_.observation.instrument.detector.gain_e_adu,
                               c.sky,
                               c.sky_err,
                               c.pixels,
                               c.var_read,
                               c.excess2,
                               r.airmass,
                               r.k_mag,
                               c.row[0],
                               c.row[1],
                               c.row[2],
                               c.row[3],
                               e.middle.phase_angle.degrees(),
                               scattering_axis(e.middle, s_.scenario.frame).degrees(),
                               c.scintillation};
      for (std::size_t k = 0; k < std::size(values); ++k)
        numbers_[k].push_back(values[k]);
    }
  }

  Table table() && {
    Table out;
    out.add("time_utc", "", "UTC of the middle of the exposure", std::move(time_));
    out.add("exposure", "", "number in the run", std::move(exposure_));
    out.add("set_id", "", "exposures that belong together", std::move(set_));
    out.add("name", "", "object", std::move(name_));
    out.add("band", "", "band", std::move(band_));
    out.add("channel", "", "beam, camera or orientation", std::move(channel_));
    const char *const columns[][3] = {
        {"analyser_deg", "deg", "angle of the analyser from the instrument's x axis"},
        {"plate_deg", "deg", "angle of the plate in the middle of the exposure"},
        {"x_axis_pa", "deg", "position angle of the instrument's x axis"},
        {"counts", "electron", "in the aperture, sky included"},
        {"counts_adu", "adu", "the same in the camera's numbers"},
        {"sky", "electron", "sky and dark in the aperture, from the ring around it"},
        {"sky_err", "electron", "standard deviation of sky"},
        {"n_pixel", "", "pixels in the aperture"},
        {"var_read", "electron2", "variance of reading and rounding"},
        {"excess2", "", "variance of multiplied electrons over Poisson's"},
        {"airmass", "", "of the apparent altitude, Kasten & Young 1989"},
        {"k_mag", "mag", "extinction per air mass in the band"},
        {"w0", "electron m2 nm / W", "counts - sky = w0 I + w1 Q + w2 U + w3 V"},
        {"w1", "electron m2 nm / W", "of Q"},
        {"w2", "electron m2 nm / W", "of U"},
        {"w3", "electron m2 nm / W", "of V"},
        {"phase_angle", "deg", "Sun-object-observer"},
        {"pa_scat", "deg", "position angle of the normal of the scattering plane"},
        {"scint_sd", "", "relative standard deviation of the transparency by scintillation"}};
    for (std::size_t k = 0; k < std::size(columns); ++k) {
      if (k == 10)
        out.add("saturated", "", "a pixel is full", std::move(saturated_));
      out.add(columns[k][0], columns[k][1], columns[k][2], std::move(numbers_[k]));
    }
    return out;
  }

private:
  const Setup &s_;
  std::vector<std::string> time_, name_, band_, channel_;
  std::vector<std::int64_t> exposure_, set_;
  std::vector<bool> saturated_;
  std::array<std::vector<double>, 19> numbers_;
};

/// Columns of the truth.
class TruthTable {
public:
  explicit TruthTable(const Setup &s) : s_(s) {}

  void add(const Exposure &e, const Recorded &r) {
    const BandResponse &band = s_.observers[e.planned.band].band();
    time_.push_back(to_iso(e.middle.time));
    name_.push_back(s_.object);
    band_.push_back(band.name);
    exposure_.push_back(e.planned.plan.index);
    set_.push_back(static_cast<std::int64_t>(e.planned.set));
    double electrons = 0, sky = 0;
    for (const ChannelCounts &c : r.channels)
      electrons += c.mean_star, sky += c.mean_sky;
    const double i = r.truth.i;
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const double values[] = {i,
                             i > 0 ? r.truth.q / i : none,
                             i > 0 ? r.truth.u / i : none,
                             i > 0 ? r.truth.v / i : none,
                             i > 0 ? -2.5 * std::log10(i / band.zero_flux) : none,
                             electrons,
                             sky,
                             e.middle.azimuth.degrees(),
                             e.middle.altitude.degrees(),
                             r.rate_rad_s * 180 / pi};
    for (std::size_t k = 0; k < std::size(values); ++k)
      numbers_[k].push_back(values[k]);
  }

  Table table() && {
    Table out;
    out.add("time_utc", "", "UTC of the middle of the exposure", std::move(time_));
    out.add("exposure", "", "number in the run", std::move(exposure_));
    out.add("set_id", "", "exposures that belong together", std::move(set_));
    out.add("name", "", "object", std::move(name_));
    out.add("band", "", "band", std::move(band_));
    const char *const columns[][3] = {
        {"I", "W / (m2 nm)", "mean over the exposure above the air, photon-weighted"},
        {"q", "", "Q/I in the sky frame"},
        {"u", "", "U/I in the sky frame"},
        {"v", "", "V/I"},
        {"mag", "mag(AB)", "AB magnitude above the air"},
        {"star_e", "electron", "expected of the object in all channels"},
        {"sky_e", "electron", "expected of sky and dark in all channels"},
        {"az", "deg", "azimuth, geometric"},
        {"alt", "deg", "altitude, geometric"},
        {"rate", "deg / s", "motion over the sky"}};
    for (std::size_t k = 0; k < std::size(columns); ++k)
      out.add(columns[k][0], columns[k][1], columns[k][2], std::move(numbers_[k]));
    return out;
  }

private:
  const Setup &s_;
  std::vector<std::string> time_, name_, band_;
  std::vector<std::int64_t> exposure_, set_;
  std::array<std::vector<double>, 10> numbers_;
};

void note(Table &table, const Scenario &scenario, const ObservedBands &bands) {
  const ScenarioObservation &o = *scenario.observation;
  note_conventions(table);
  table.note("pol_frame", name_of(scenario.frame));
  table.note("instrument", o.instrument.name.empty() ? "in the scenario" : o.instrument.name);
  table.note("polarimeter", name_of(o.instrument.polarimeter.type));
  table.note("pupils", o.instrument.polarimeter.has_separate_pupils ? "separate" : "common");
  table.note("parameters", fmt::format("{}", parameters_of(o.instrument.polarimeter.type)));
  table.note("mag_system", "AB");
  for (const BandResponse &band : bands.bands)
    table.note("zero_flux " + band.name, shortest(band.zero_flux));
  table.note("seed", fmt::format("{}", scenario.seed));
}

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

Result<std::vector<BandObserver>> observers_of(const ScenarioObservation &o,
                                               const ObservedBands &bands,
                                               const ObservingConditions &conditions) {
  std::vector<BandObserver> out;
  for (const BandResponse &band : bands.bands) {
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

/// The sampling of a mosaic's image, in figures.
void warn_of_mosaic(const Setup &s, Diagnostics &diagnostics) {
  const ScenarioObservation &o = s.observation;
  if (o.instrument.polarimeter.type != PolarimeterType::Mosaic)
    return;
  for (const BandObserver &observer : s.observers) {
    const double width = observer.fwhm_arcsec(1) / observer.pixel_arcsec();
    if (width < 3 || o.aperture_fwhm < 2)
      diagnostics.warn(fmt::format(
          "{}: a star is {:.2g} px wide at the zenith and {:g} widths are summed; under 3 px, or "
          "under 2 widths, summed light of the four orientations is polarized by where the star "
          "stands on its pixels, up to {:.2g} in q. Defocus, or fit the image of each orientation.",
          observer.band().name, width, o.aperture_fwhm, 2 * mosaic_alias_strength(width)));
  }
}

/// The exposures of a span in which the object is seen, in order of time.
Result<std::vector<Exposure>> exposures_of(const Scenario &scenario, const Track &track,
                                           const LightCurveRequest &request,
                                           const Programme &programme, std::uint32_t object,
                                           const Monitor &monitor) {
  static const std::atomic<bool> never{false};
  const ScenarioObservation &o = *scenario.observation;
  const double half = o.exposure_s / 2;
  EpochSpan span{plus_seconds(request.span.start, half), plus_seconds(request.span.stop, -half),
                 o.cadence_s};
  if (seconds_between(span.stop, span.start) < 0)
    return fail(
        ErrorCode::BadInput,
        fmt::format("observation.exposure_s = {} is longer than the span of [time]", o.exposure_s));
  UMOV_ASSIGN(kept, keep_epochs(track, span, request.only, request.threads,
                                monitor.cancel != nullptr ? *monitor.cancel : never));
  Draws clock({scenario.seed, object, 0, 0, 0xc10c});
  const double clock_error = o.clock_error_s * clock.normal();
  Cloud cloud(o, scenario.seed, object);
  std::vector<Exposure> out;
  for (const ObservingGeometry &g : kept.geometry) {
    if (!(g.altitude.radians() > 0)) // there is no air mass below the horizon
      continue;
    const auto k =
        static_cast<std::size_t>(std::llround(seconds_between(g.time, span.start) / o.cadence_s));
    const double elapsed = out.empty() ? 0 : seconds_between(g.time, out.back().middle.time);
    out.push_back({programme.at(k), g, plus_seconds(g.time, clock_error), cloud.next(elapsed)});
  }
  return out;
}

/// Times in which the light may change most: a flat mirror's flash lasts as long as the Sun's disk,
/// seen by the half vector, takes to pass.
double shortest_feature_s(const Track &track, const std::vector<Exposure> &exposures) {
  constexpr double disk_rad = 0.2665 * pi / 180;
  std::vector<ObservingGeometry> samples;
  const std::size_t step = std::max<std::size_t>(1, exposures.size() / 200);
  for (std::size_t k = 0; k < exposures.size(); k += step)
    samples.push_back(exposures[k].middle);
  const double rate = track.half_vector_rate(samples);
  return rate > 0 ? disk_rad / rate : 0;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

struct Tables {
  CountsTable counts;
  TruthTable truth;
};

Result<void> run_blocks(const Setup &s, const std::vector<Exposure> &exposures,
                        const Monitor &monitor, Tables &tables, Observation &out,
                        Diagnostics &diagnostics) {
  // About 5 kB for each time within an exposure at which the light is computed.
  const std::size_t block =
      std::clamp<std::size_t>(65'536 / std::max<std::size_t>(1, s.nodes.size()), 1, 4096);
  std::size_t unknown_twilight = 0;
  for (std::size_t begin = 0; begin < exposures.size(); begin += block) {
    if (monitor.is_cancelled())
      return fail(ErrorCode::Interrupted, "stopped; nothing was written");
    const std::span<const Exposure> part(exposures.data() + begin,
                                         std::min(block, exposures.size() - begin));
    const auto lit_from = std::chrono::steady_clock::now();
    UMOV_ASSIGN(lit, light_of(s, part));
    out.light_s += seconds_since(lit_from);
    const auto counted_from = std::chrono::steady_clock::now();
    std::vector<Recorded> recorded(part.size());
    parallel_for(part.size(), s.threads,
                 [&](std::size_t k) { recorded[k] = record(s, part[k], k, lit); });
    for (std::size_t k = 0; k < part.size(); ++k) {
      if (recorded[k].error)
        return tl::unexpected(*recorded[k].error);
      tables.counts.add(part[k], recorded[k]);
      tables.truth.add(part[k], recorded[k]);
      unknown_twilight += recorded[k].is_twilight_unknown ? 1u : 0u;
      const bool is_full =
          std::ranges::any_of(recorded[k].channels, [](const auto &c) { return c.is_saturated; });
      out.saturated += is_full ? 1u : 0u;
    }
    out.counts_s += seconds_since(counted_from);
    out.exposures += part.size();
    monitor.advance("exposures", begin + part.size(), exposures.size());
  }
  if (unknown_twilight > 0)
    diagnostics.warn(fmt::format("{} with the Sun above -5 deg: the sky's brightness in twilight "
                                 "is only known below; give atmosphere.sky.mag",
                                 counted(unknown_twilight, "exposure")));
  return {};
}

/// Circumstances that the models do not reach.
void warn_of_air(const std::vector<Exposure> &exposures, const Setup &s, Diagnostics &diagnostics) {
  std::size_t low = 0;
  for (const Exposure &e : exposures)
    low += apparent_altitude(550, e.middle.altitude, s.surface).degrees() < 3 ? 1u : 0u;
  if (low > 0)
    diagnostics.warn(fmt::format("{} below an apparent altitude of 3 deg: air mass is "
                                 "extrapolated there",
                                 counted(low, "exposure")));
}

Result<void> observe_object(const Scenario &scenario, const ObservedBands &bands,
                            const Programme &programme, std::uint32_t object,
                            const JobOptions &options, const Monitor &monitor, Observation &out,
                            Diagnostics &diagnostics) {
  UMOV_ASSIGN(loaded,
              load_object(scenario, object,
                          {options.allow_bad_checksum, options.allow_old_elements}, diagnostics));
  LightCurveRequest request =
      light_curve_request(scenario, scenario.objects[object], loaded, options);
  out.inputs.insert(out.inputs.end(), loaded.inputs.begin(), loaded.inputs.end());
  UMOV_ASSIGN(track, Track::make(request.track));
  UMOV_ASSIGN(exposures, exposures_of(scenario, track, request, programme, object, monitor));
  if (exposures.empty())
    return {};
  const auto began = std::chrono::steady_clock::now();
  UMOV_ASSIGN(models, make_light_models(request, loaded.scene));
  const ObservingConditions conditions = conditions_of(scenario, object);
  UMOV_ASSIGN(observers, observers_of(*scenario.observation, bands, conditions));
  for (const Exposure &e : exposures)
    if (!observers[e.planned.band].is_prepared(e.planned.plan.state))
      UMOV_TRY(observers[e.planned.band].prepare(e.planned.plan.state));
  const Setup setup{
      scenario,
      *scenario.observation,
      bands,
      *models.light,
      track,
      std::move(observers),
      exposure_nodes(scenario.observation->exposure_s, shortest_feature_s(track, exposures)),
      request.object,
      {conditions.air.pressure_hpa, 283.15, 4},
      extinction_mag(550, conditions.air),
      options.threads};
  out.light_s += seconds_since(began);
  warn_of_mosaic(setup, diagnostics);
  warn_of_air(exposures, setup, diagnostics);
  Tables tables{CountsTable(setup), TruthTable(setup)};
  UMOV_TRY(run_blocks(setup, exposures, monitor, tables, out, diagnostics));
  out.counts.append(std::move(tables.counts).table());
  out.truth.append(std::move(tables.truth).table());
  return models.keep_masks();
}

} // namespace

Result<Observation> observe(const Scenario &given, const JobOptions &options,
                            const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_TRY(check_complete_for_run(given));
  if (!given.observation)
    return fail(ErrorCode::BadInput,
                "umov observe also needs [observation] and an instrument: add instrument = "
                "\"c11_imx250\" (umov instrument list has others) and [observation] exposure_s",
                {given.file});
  UMOV_ASSIGN(bands, observed_bands(given));
  UMOV_ASSIGN(programme, Programme::make(*given.observation, bands.bands));
  Scenario scenario = given;
  scenario.bands = bands.nodes;
  warn_if_beyond_leap_seconds(scenario.time->stop, diagnostics);
  warn_if_outside_eop(scenario.time->start, scenario.time->stop, diagnostics);
  Observation out;
  for (std::size_t k = 0; k < scenario.objects.size(); ++k)
    UMOV_TRY(observe_object(scenario, bands, programme, static_cast<std::uint32_t>(k), options,
                            monitor, out, diagnostics));
  if (out.exposures == 0)
    return fail(ErrorCode::Nothing, "no exposure falls in a pass; umov passes tells when there is "
                                    "one");
  if (out.saturated == out.exposures)
    return fail(ErrorCode::Physics,
                fmt::format("every exposure of {} is saturated. Shorten observation.exposure_s = "
                            "{}, or defocus (atmosphere.seeing.arcsec)",
                            out.exposures, scenario.observation->exposure_s));
  if (out.saturated > 0)
    diagnostics.warn(fmt::format("{} of {} exposures are saturated", out.saturated, out.exposures));
  note(out.counts, scenario, bands);
  note(out.truth, scenario, bands);
  return out;
}

Result<void> write_observation(const Observation &observation, const Scenario &scenario,
                               ManifestInput manifest, const Diagnostics &diagnostics,
                               RunFolder &folder) {
  for (const auto &[name, table] :
       {std::pair<std::string, const Table *>{"counts", &observation.counts},
        {"truth", &observation.truth}}) {
    for (const std::string &format : scenario.formats) {
      if (format == "html")
        continue;
      std::string bytes;
      if (format == "fits") {
        UMOV_ASSIGN(made, to_fits(*table));
        bytes = std::move(made);
      } else {
        bytes = format == "csv" ? to_csv(*table) : to_ecsv(*table);
      }
      manifest.files.push_back(fmt::format("{}.{}", name, format));
      folder.add(manifest.files.back(), std::move(bytes));
    }
  }
  folder.add("scenario.lock.toml", locked_scenario(scenario));
  std::string log =
      fmt::format("{}, {} rows of counts\n", counted(observation.exposures, "exposure"),
                  observation.counts.rows());
  for (const Warning &warning : diagnostics.warnings()) {
    log += "warning: " + warning.text() + "\n";
    manifest.warnings.push_back(warning.text());
  }
  folder.add("log.txt", std::move(log));
  for (const InputFile &input : observation.inputs)
    manifest.inputs.emplace_back(input.path, input.sha256);
  manifest.seed = scenario.seed;
  folder.add("manifest.json", make_manifest(manifest));
  return folder.commit();
}

} // namespace umov::jobs
