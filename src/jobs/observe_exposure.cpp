#include "jobs/observe_frames.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/parallel.h>
#include <umov/frames/sky.h>
#include <umov/photometry/radiometry.h>

namespace umov::jobs {

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

Angle x_axis_from_zenith(const Instrument &instrument, const ObservingGeometry &g) {
  return axis_from_zenith(instrument.telescope, Angle::degrees(instrument.polarimeter.x_axis_deg),
                          zenith_in(PolarizationFrame::Equatorial, g), g.altitude, g.azimuth);
}

Result<LitBlock> light_of(const Setup &s, const LightModel &light,
                          std::span<const Exposure> exposures, const Monitor &monitor) {
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
  task.cancel = monitor.cancel;
  if (!light.evaluate_at_nodes(poses, angles, out.table, task))
    return fail(ErrorCode::Interrupted, "stopped; nothing was written");
  return out;
}

namespace {

/// Light of one node of an exposure and a band, in the scattering plane, as irradiance at the site
/// with the Sun's spectrum replaced by its mean in the band.
Stokes<ScatteringPlane> irradiance_of(const BandResult &lit, const BandResponse &band,
                                      const ObservingGeometry &g) {
  return lit.stokes *
         irradiance_at_observer(1, band.solar_mean, g.sun_distance_km, g.sunlit, g.range_km);
}

/// Light of each node of the exposure, as it reaches the polarimeter.
using Moments = std::vector<std::vector<Stokes<InstrumentAxes>>>;
/// The band's light of each node above the air.
using Truths = std::vector<Stokes<SkyNorth>>;

Stokes<SkyNorth> mean_of(const Truths &truths, const std::vector<double> &weight) {
  Stokes<SkyNorth> out{};
  for (std::size_t n = 0; n < truths.size(); ++n)
    out += truths[n] * weight[n];
  return out;
}

ExposureLight arriving(const Setup &s, const Exposure &e, std::size_t number, const LitBlock &lit,
                       Recorded &out, Moments &moments, Truths &truths) {
  const BandObserver &observer = s.observers[e.planned.band];
  const BandResponse &band = observer.band();
  const ObservingGeometry &g = e.middle;
  ExposureLight light;
  light.flux.resize(band.nm.size());
  moments.resize(s.nodes.size());
  truths.assign(s.nodes.size(), {});
  for (std::size_t n = 0; n < s.nodes.size(); ++n) {
    const std::size_t at = number * s.nodes.size() + n;
    const ObservingGeometry &now = lit.points[at].geometry;
    const Angle x_axis = x_axis_from_zenith(s.observation.instrument, now);
    const Angle to_file =
        Angle::radians(-now.pa_scat_altaz.radians() - zenith_in(s.scenario.frame, now).radians());
    for (std::size_t k = 0; k < band.nm.size(); ++k) {
      const auto light_here =
          irradiance_of(lit.table.at(at, s.terms[e.planned.band][k].node), band, now);
      const auto zenith_axes =
          rotate_to<SkyNorth>(light_here, Angle::radians(-now.pa_scat_altaz.radians()));
      const auto here = observer.at_polarimeter(k, zenith_axes, now.altitude, x_axis, now.azimuth);
      light.flux[k] += here * s.nodes[n].weight;
      if (s.observation.makes_frames)
        moments[n].push_back(here);
      truths[n] += rotate_to<SkyNorth>(light_here, to_file) * band.weight[k];
    }
    out.truth += truths[n] * s.nodes[n].weight;
  }
  light.sky = sky_light(s.sky, band, g);
  light.altitude = g.altitude;
  light.azimuth = g.azimuth;
  const Angle seen = apparent_altitude(band.pivot_nm, g.altitude, s.surface);
  light.airmass = airmass(seen);
  light.axis_zenith = x_axis_from_zenith(s.observation.instrument, g);
  light.zenith = zenith_in(s.scenario.frame, g);
  light.transparency = e.cloud;
  const auto &first = lit.points[number * s.nodes.size()].geometry;
  const auto &last = lit.points[(number + 1) * s.nodes.size() - 1].geometry;
  light.rate_rad_s = angle_between(first.to_observer, last.to_observer) /
                     std::max(1e-9, s.nodes.back().offset_s - s.nodes.front().offset_s);
  return light;
}

/// How many times as long as a row the object is exposed.
double stretch_of(const Setup &s, const Exposure &e, std::span<const TrackPoint> points) {
  const Instrument &instrument = s.observation.instrument;
  const bool may_roll = instrument.detector.has_rolling_shutter &&
                        instrument.telescope.tracking != Tracking::Satellite;
  return may_roll ? FrameView(s, e).stretch(points) : 1;
}

/// BadInput for what runs over a rolling shutter's rows nearly as fast as they are read: its
/// exposure has no length, and its trail no light of one moment.
Result<void> check_shutter(const Setup &s, const Exposure &e, std::span<const TrackPoint> points) {
  const Instrument &instrument = s.observation.instrument;
  const bool trails = instrument.telescope.tracking != Tracking::Satellite || !s.stars.empty();
  if (!instrument.detector.has_rolling_shutter || !trails)
    return {};
  const double rows_per_s = FrameView(s, e).rows_per_s(points);
  const double of_readout = rolling_change(instrument.detector, rows_per_s);
  constexpr double most = 0.5;
  if (of_readout <= most)
    return {};
  return fail(ErrorCode::BadInput,
              fmt::format("trails run over {:.3g} rows a second, {:.2g} of what a rolling shutter "
                          "with detector.line_time_s = {:g} reads: up to {:g} was expected. Give "
                          "telescope.tracking = \"satellite\" without stars, or shutter = "
                          "\"global\"",
                          rows_per_s, of_readout, instrument.detector.line_time_s, most),
              s.scenario.place("detector.line_time_s"));
}

} // namespace

Recorded record(const Setup &s, const Exposure &e, std::size_t number, const LitBlock &lit) {
  Recorded out;
  const BandObserver &observer = s.observers[e.planned.band];
  Moments moments;
  Truths truths;
  ExposureLight light = arriving(s, e, number, lit, out, moments, truths);
  const std::span<const TrackPoint> points(&lit.points[number * s.nodes.size()], s.nodes.size());
  if (const auto fits = check_shutter(s, e, points); !fits) {
    out.error = fits.error();
    return out;
  }
  const double stretch = stretch_of(s, e, points);
  for (Stokes<InstrumentAxes> &flux : light.flux)
    flux = flux * stretch;
  light.trail_px =
      stretch * trail_length_px(rate_over_detector(s.observation.instrument.telescope.tracking,
                                                   points.front().geometry, points.back().geometry),
                                e.planned.plan.exposure_s, observer.pixel_arcsec());
  const Angle on_sky = axis_on_sky(s.observation.instrument.telescope, light.axis_zenith,
                                   e.middle.altitude, e.middle.azimuth);
  out.axis = Angle::radians(on_sky.radians() + light.zenith.radians());
  out.airmass = light.airmass;
  out.rate_rad_s = light.rate_rad_s;
  constexpr double notable = 1e-3;
  out.is_rolled = std::abs(stretch - 1) > notable;
  out.k_mag = -2.5 * std::log10(observer.mean_transmission(light.airmass)) / light.airmass;
  if (s.observation.makes_frames) {
    const double width = observer.fwhm_arcsec(light.airmass) / observer.pixel_arcsec();
    auto framed = observe_frames(observer, s.images, e.planned.plan, light,
                                 FrameView(s, e).plan(points, std::move(moments), width));
    if (!framed) {
      out.error = framed.error();
      return out;
    }
    out.channels = std::move(framed->channels);
    for (FramedSlice &slice : framed->slices)
      out.slices.push_back(
          {slice.offset_s, std::move(slice.channels), mean_of(truths, slice.weight)});
    framed->slices.clear();
    out.frames = std::move(*framed);
    return out;
  }
  auto counts = observer.observe(e.planned.plan, light);
  if (counts)
    out.channels = std::move(*counts);
  else
    out.error = counts.error();
  return out;
}

} // namespace umov::jobs
