#include <umov/lightcurve/compute.h>

#include "lightcurve/passes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <umov/core/constants.h>
#include <umov/core/parallel.h>
#include <umov/frames/sky.h>
#include <umov/light/articulated_engine.h>
#include <umov/light/engine.h>
#include <umov/photometry/radiometry.h>
#include <umov/photometry/refracted_shadow.h>

namespace umov {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t max_epochs = 10'000'000;

/// Epochs per work unit: also the grain of progress, cancelling and stopping.
constexpr std::size_t block = 256;

/// A scenario calls the span [time].
Error in_scenario_words(Error error) {
  constexpr std::string_view plain = "Shorten the span";
  if (const std::size_t at = error.message.find(plain); at != std::string::npos)
    error.message.replace(at, plain.size(), "Shorten [time]");
  return error;
}

/// Position angle in [0, 180) deg of linear polarization, NaN where there is none.
double position_angle_deg(double q, double u) {
  if (!(q * q + u * u > 0))
    return nan;
  const double angle = 0.5 * std::atan2(u, q) * (180 / pi);
  return angle < 0 ? (angle + 180 < 180 ? angle + 180 : 0) : angle;
}

/// Sunlight at the object in a band, in parts of that outside all shadows.
double sunlight(const LightCurveRequest &request, const ObservingGeometry &g, const Band &band) {
  if (!request.has_refracted_shadow)
    return g.sunlit;
  const double distance = norm(g.gcrs_km);
  const Vec3<Gcrs> down = -1 * g.gcrs_km / distance;
  // The ellipsoid's radius under the limb that the Sun stands over.
  const Vec3<Gcrs> side = g.to_sun - down * dot(g.to_sun, down);
  const double limb = std::acos(std::min(1.0, constants::wgs84_a_km / distance));
  const double up = norm(side) > 1e-12 ? normalized(side).z : 0;
  const double sine = -down.z * std::cos(limb) + up * std::sin(limb); // of the limb's latitude
  const double radius = constants::wgs84_a_km * (1 - constants::wgs84_f * sine * sine);
  const Angle disk = Angle::radians(std::asin(constants::sun_radius_km / g.sun_distance_km));
  return refracted_sunlight(disk, radius, distance, Angle::radians(angle_between(g.to_sun, down)),
                            band.wavelength) *
         sunlit_beside_moon(g.time, g.gcrs_km, g.sun_gcrs_km);
}

LightCurveSample sample_from(const BandResult &band, const Band &colour, double solar,
                             const ObservingGeometry &geometry, const LightCurveRequest &request,
                             bool is_dark) {
  const PolarizationFrame frame = request.frame;
  LightCurveSample out;
  out.intensity = band.stokes.i;
  out.half_width = band.half_width;
  out.irradiance = irradiance_at_observer(band.stokes.i, solar, geometry.sun_distance_km,
                                          sunlight(request, geometry, colour), geometry.range_km);
  out.magnitude = ab_magnitude(out.irradiance, colour.wavelength);
  if (is_dark || !(band.stokes.i > 0)) {
    out.sky = {nan, nan, nan, nan};
    out.scattering = {nan, nan, nan, nan};
    out.p = out.dop = out.pa_deg = nan;
    return out;
  }
  out.scattering = band.stokes * (1 / band.stokes.i);
  const Angle axis = frame == PolarizationFrame::Equatorial ? geometry.pa_scat_equatorial
                     : frame == PolarizationFrame::AltAz    ? geometry.pa_scat_altaz
                                                            : Angle();
  out.sky = rotate_to<SkyNorth>(out.scattering, Angle::radians(-axis.radians()));
  const auto &s = out.scattering;
  out.p = std::sqrt(s.q * s.q + s.u * s.u);
  out.dop = std::sqrt(s.q * s.q + s.u * s.u + s.v * s.v);
  out.pa_deg = position_angle_deg(out.sky.q, out.sky.u);
  return out;
}

AttitudeContext context_of(const ObservingGeometry &g) {
  return {g.time, g.gcrs_km, g.gcrs_velocity_km_s, g.to_sun, g.to_observer};
}

/// The epochs of the span that pass the filter, in order, with their passes.
struct Selection {
  std::vector<EpochGeometry> grid;
  std::vector<std::size_t> kept;      ///< into grid
  std::vector<std::size_t> kept_pass; ///< per kept epoch, into passes
  std::vector<Pass> passes;
  std::size_t passes_seen = 0;
  std::optional<Error> stopped;
};

Result<Selection> select_epochs(const LightCurveRequest &request, const std::atomic<bool> &cancel) {
  UMOV_ASSIGN(times, time_grid(request.start, request.stop, request.step_s));
  Selection out;
  out.grid.resize(times.size());
  const std::size_t blocks = (times.size() + block - 1) / block;
  parallel_for(blocks, request.threads, [&](std::size_t b) {
    if (cancel)
      return;
    for (std::size_t i = b * block; i < std::min((b + 1) * block, times.size()); ++i)
      out.grid[i] = geometry_at(request, times[i]);
  });
  if (cancel)
    return fail(ErrorCode::Interrupted, "stopped before the first row");
  for (std::size_t i = 0; i < out.grid.size() && !out.stopped; ++i)
    if (!out.grid[i].is_there) {
      out.stopped = in_scenario_words(request.orbit.at(times[i]).error());
      out.grid.resize(i);
    }
  for (const GridPass &span : group_passes(out.grid, request.only)) {
    ++out.passes_seen;
    const std::size_t before = out.kept.size();
    for (std::size_t i = span.first; i <= span.last; ++i)
      if (is_kept(out.grid[i], request.only)) {
        out.kept.push_back(i);
        out.kept_pass.push_back(out.passes.size());
      }
    if (out.kept.size() == before)
      continue;
    out.passes.push_back(describe_pass(span, out.grid, request));
    out.passes.back().rows = out.kept.size() - before;
  }
  return out;
}

} // namespace

Result<std::vector<Epoch<Utc>>> time_grid(Epoch<Utc> start, Epoch<Utc> stop, double step_s) {
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

namespace {

/// What the rows of all epochs share.
struct RowMaker {
  const LightCurveRequest &request;
  const Scene &scene;
  const Integrator &integrator;
  const std::vector<double> &solar; ///< per band
  Attitude attitude;
  /// For the many directions of other sources: one of them, by whether parts turn.
  const Engine *engine;
  const ArticulatedEngine *turning;

  /// Where the object is, how it is turned and how it is lit and seen; gives its attitude.
  Result<Rotation<Body, Gcrs>> place(const ObservingGeometry &geometry, const std::string &pass_id,
                                     LightCurveEpoch &epoch) const;
  /// The light at epochs that have been placed; Interrupted once `cancel` is true.
  [[nodiscard]] Result<std::vector<PoseResult>> light_of(std::span<const LightCurveEpoch> epochs,
                                                         const std::atomic<bool> &cancel) const;
  void put(const PoseResult &light, const Rotation<Body, Gcrs> &body_from_gcrs, std::size_t row,
           LightCurve &curve) const;
  void add_second_lights(const ObservingGeometry &geometry, const LightCurveEpoch &epoch,
                         const Rotation<Body, Gcrs> &body_from_gcrs, std::size_t row,
                         LightCurve &curve) const;
};

Result<std::vector<PoseResult>> RowMaker::light_of(std::span<const LightCurveEpoch> epochs,
                                                   const std::atomic<bool> &cancel) const {
  std::vector<PoseResult> out;
  if (request.joints.empty()) {
    std::vector<Pose> poses;
    for (const LightCurveEpoch &epoch : epochs)
      poses.push_back(epoch.pose);
    out = integrator.evaluate(poses, request.integration, request.threads, &cancel);
  } else { // the mesh of an articulated object is another one at every epoch
    out.resize(epochs.size());
    parallel_for(epochs.size(), request.threads, [&](std::size_t k) {
      if (cancel)
        return;
      Scene turned = scene;
      turned.mesh = posed(scene.mesh, joints_of(request.joints), epochs[k].joint_angles_rad);
      out[k] = Integrator(turned).evaluate(epochs[k].pose, request.integration);
    });
  }
  if (cancel)
    return fail(ErrorCode::Interrupted, "");
  return out;
}

/// Many directions at one epoch, by masks.
void RowMaker::add_second_lights(const ObservingGeometry &geometry, const LightCurveEpoch &epoch,
                                 const Rotation<Body, Gcrs> &body_from_gcrs, std::size_t row,
                                 LightCurve &curve) const {
  const std::size_t bands = scene.bands.size();
  const auto light = [&](const std::vector<Pose> &poses) {
    StokesTable table;
    if (turning != nullptr) {
      std::vector<double> angles;
      for (std::size_t k = 0; k < poses.size(); ++k)
        angles.insert(angles.end(), epoch.joint_angles_rad.begin(), epoch.joint_angles_rad.end());
      turning->evaluate(poses, angles, table);
    } else {
      engine->evaluate(poses, table);
    }
    std::vector<std::vector<BandResult>> out(poses.size());
    for (std::size_t k = 0; k < poses.size(); ++k)
      for (std::size_t b = 0; b < bands; ++b)
        out[k].push_back(table.at(k, b));
    return out;
  };
  const Vec3<Gcrs> north = request.frame == PolarizationFrame::Equatorial ? Vec3<Gcrs>{0, 0, 1}
                           : request.frame == PolarizationFrame::AltAz
                               ? geometry.zenith
                               : scattering_normal(geometry.to_observer, geometry.to_sun);
  EarthshineOptions earth = request.earthshine.value_or(EarthshineOptions{});
  earth.narrowest_lobe = narrowest_lobe(scene);
  for (SecondLight &second : curve.second_lights) {
    const auto sum = second.name == "moon"
                         ? moon_light(geometry, body_from_gcrs, north, bands, light)
                         : earth_light(geometry, body_from_gcrs, north, earth, bands, light);
    for (std::size_t b = 0; b < bands; ++b) {
      second.intensity[row * bands + b] = sum.stokes[b];
      second.half_width[row * bands + b] = sum.half_width[b];
      second.irradiance[row * bands + b] = irradiance_at_observer(
          sum.stokes[b].i, solar[b], geometry.sun_distance_km, 1, geometry.range_km);
    }
  }
}

Result<Rotation<Body, Gcrs>> RowMaker::place(const ObservingGeometry &geometry,
                                             const std::string &pass_id,
                                             LightCurveEpoch &epoch) const {
  UMOV_ASSIGN(body_from_gcrs, attitude.at(context_of(geometry)));
  epoch.geometry = geometry;
  epoch.body_from_gcrs = quaternion_from(body_from_gcrs);
  epoch.pose = {
      normalized(body_from_gcrs * geometry.to_sun),
      normalized(body_from_gcrs * geometry.to_observer),
      request.has_solar_disk ? std::asin(constants::sun_radius_km / geometry.sun_distance_km) : 0};
  epoch.airmass = airmass(geometry.altitude);
  epoch.pass_id = pass_id;
  epoch.elset_age_days = request.orbit.element_age_days(geometry.time);
  if (!request.joints.empty()) {
    UMOV_ASSIGN(angles, joint_angles(request.joints, context_of(geometry), body_from_gcrs));
    epoch.joint_angles_rad = std::move(angles);
  }
  return body_from_gcrs;
}

void RowMaker::put(const PoseResult &light, const Rotation<Body, Gcrs> &body_from_gcrs,
                   std::size_t row, LightCurve &curve) const {
  LightCurveEpoch &epoch = curve.epochs[row];
  epoch.is_dark = light.is_dark;
  epoch.has_glint = light.glint_share > 0.5;
  const std::size_t bands = scene.bands.size();
  for (std::size_t b = 0; b < bands; ++b)
    curve.samples[row * bands + b] = sample_from(light.bands[b], scene.bands[b], solar[b],
                                                 epoch.geometry, request, light.is_dark);
  for (std::size_t b = 0; b < light.indirect.size(); ++b)
    if (light.bands[b].stokes.i > 0)
      curve.samples[row * bands + b].indirect = light.indirect[b] * (1 / light.bands[b].stokes.i);
  std::copy(light.group_intensity.begin(), light.group_intensity.end(),
            curve.group_intensity.begin() +
                static_cast<std::ptrdiff_t>(row * light.group_intensity.size()));
  if (!curve.second_lights.empty())
    add_second_lights(epoch.geometry, epoch, body_from_gcrs, row, curve);
}

LightCurve empty_curve(const LightCurveRequest &request, const Scene &scene, std::size_t rows) {
  LightCurve curve;
  curve.object = request.object;
  curve.bounces = request.integration.bounces;
  curve.norad_cat_id = request.orbit.norad_cat_id();
  curve.bands = scene.bands;
  curve.groups = scene.mesh.groups;
  for (const Surface &surface : scene.front)
    curve.materials.push_back(surface.material().name);
  curve.epochs.resize(rows);
  curve.samples.resize(rows * scene.bands.size());
  curve.group_intensity.resize(rows * scene.mesh.groups.size() * scene.bands.size());
  if (request.earthshine)
    curve.second_lights.push_back({"earth", {}, {}, {}});
  if (request.has_moonlight)
    curve.second_lights.push_back({"moon", {}, {}, {}});
  for (SecondLight &second : curve.second_lights) {
    second.intensity.resize(curve.samples.size());
    second.half_width.resize(curve.samples.size());
    second.irradiance.resize(curve.samples.size());
  }
  return curve;
}

void truncate(LightCurve &curve, std::size_t rows) {
  const std::size_t before = std::max<std::size_t>(1, curve.epochs.size());
  curve.samples.resize(curve.samples.size() / before * rows);
  curve.group_intensity.resize(curve.group_intensity.size() / before * rows);
  for (SecondLight &second : curve.second_lights) {
    second.intensity.resize(second.intensity.size() / before * rows);
    second.half_width.resize(second.half_width.size() / before * rows);
    second.irradiance.resize(second.irradiance.size() / before * rows);
  }
  curve.epochs.resize(rows);
}

/// After a stop some passes have fewer rows, or none and are not told of.
void count_rows(LightCurveOutcome &out) {
  for (Pass &pass : out.passes)
    pass.rows = static_cast<std::size_t>(
        std::count_if(out.curve.epochs.begin(), out.curve.epochs.end(),
                      [&](const LightCurveEpoch &e) { return e.pass_id == pass.id; }));
  std::erase_if(out.passes, [](const Pass &pass) { return pass.rows == 0; });
}

/// Fills one block of rows; how many of them before the first that cannot be placed (`stopped` says
/// why), or none if it was cancelled.
std::size_t fill_block(const RowMaker &maker, const Selection &selection, std::size_t begin,
                       std::size_t count, LightCurve &curve, const std::atomic<bool> &cancel,
                       std::optional<Error> &stopped) {
  std::vector<std::optional<Result<Rotation<Body, Gcrs>>>> attitudes(count);
  const unsigned threads = maker.request.threads;
  parallel_for(count, threads, [&](std::size_t k) {
    attitudes[k] =
        maker.place(selection.grid[selection.kept[begin + k]].geometry,
                    selection.passes[selection.kept_pass[begin + k]].id, curve.epochs[begin + k]);
  });
  std::size_t placed = 0;
  while (placed < count && attitudes[placed]->has_value())
    ++placed;
  if (placed < count)
    stopped = attitudes[placed]->error();
  const auto light = maker.light_of(std::span(curve.epochs).subspan(begin, placed), cancel);
  if (!light) {
    stopped = light.error();
    return 0;
  }
  parallel_for(placed, threads, [&](std::size_t k) {
    if (!cancel) // light of the Earth takes its time
      maker.put((*light)[k], attitudes[k]->value(), begin + k, curve);
  });
  if (cancel) {
    stopped = Error{ErrorCode::Interrupted, "", {}};
    return 0;
  }
  return placed;
}

/// Fills the rows in blocks so that a stop keeps every finished block; returns the rows kept.
std::size_t fill_rows(const RowMaker &maker, const Selection &selection, LightCurve &curve,
                      const Progress &progress, const std::atomic<bool> &cancel,
                      std::optional<Error> &stopped) {
  const std::size_t rows = selection.kept.size();
  // With light between surfaces the rows of a block share their paths.
  const std::size_t grain = maker.request.integration.bounces > 1 ? 256 : 32;
  for (std::size_t begin = 0; begin < rows; begin += grain) {
    const std::size_t count = std::min(grain, rows - begin);
    std::optional<Error> here; // the selection may have stopped before, at a later row
    const std::size_t done =
        begin + fill_block(maker, selection, begin, count, curve, cancel, here);
    if (here) {
      stopped = here;
      if (stopped->code == ErrorCode::Interrupted)
        stopped->message =
            done == 0 ? "stopped before the first row"
                      : fmt::format("stopped by the user after {} of {} epochs", done, rows);
      return done;
    }
    if (progress)
      progress(begin + count, rows);
  }
  return rows;
}

} // namespace

Result<LightCurveOutcome> compute_light_curve(const LightCurveRequest &request, const Scene &scene,
                                              const Integrator &integrator,
                                              const Progress &progress,
                                              const std::atomic<bool> &cancel) {
  if (const ElementSet *set = request.orbit.elements())
    UMOV_TRY(request.orbit.at(set->epoch)); // elements that cannot even start
  UMOV_ASSIGN(selection, select_epochs(request, cancel));
  std::vector<double> solar;
  for (const Band &band : scene.bands) {
    UMOV_ASSIGN(value, solar_irradiance(band.wavelength));
    solar.push_back(value);
  }
  UMOV_ASSIGN(attitude, Attitude::make(request.attitude, [&](Epoch<Utc> time) {
                return request.orbit.at(time).map([&](const TemeState &state) {
                  return context_of(observe(state, time, request.site, request.shadow));
                });
              }));
  LightCurveOutcome out;
  out.curve = empty_curve(request, scene, selection.kept.size());
  out.passes = selection.passes;
  out.passes_seen = selection.passes_seen;
  out.stopped = selection.stopped;
  std::optional<Engine> engine;
  std::optional<ArticulatedEngine> turning;
  if (!out.curve.second_lights.empty() && !out.curve.epochs.empty()) {
    EngineOptions options;
    options.threads = request.threads;
    if (request.joints.empty())
      engine.emplace(scene, options);
    else
      turning.emplace(scene, joints_of(request.joints), options);
  }
  const RowMaker maker{request,
                       scene,
                       integrator,
                       solar,
                       attitude,
                       engine ? &*engine : nullptr,
                       turning ? &*turning : nullptr};
  truncate(out.curve, fill_rows(maker, selection, out.curve, progress, cancel, out.stopped));
  count_rows(out);
  return out;
}

std::optional<NextPass> find_next_pass(const LightCurveRequest &request, Epoch<Utc> from,
                                       double days) {
  constexpr double step_s = 20; // shorter than any useful pass; the time is told to the minute
  std::optional<NextPass> found;
  for (double s = 0; s <= days * 86400; s += step_s) {
    const EpochGeometry at = geometry_at(request, plus_seconds(from, s));
    if (!at.is_there)
      return found;
    if (!found && is_kept(at, request.only))
      found = NextPass{at.geometry.time, at.geometry.altitude};
    else if (found && !is_above(at, request.only))
      return found;
    if (found && at.geometry.altitude.radians() > found->altitude_max.radians())
      found->altitude_max = at.geometry.altitude;
  }
  return found;
}

} // namespace umov
