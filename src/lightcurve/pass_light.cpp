#include <umov/lightcurve/pass_light.h>

#include <algorithm>
#include <cmath>
#include <umov/core/constants.h>
#include <umov/light/engine.h>
#include <umov/photometry/radiometry.h>
#include <umov/shape/primitives.h>

namespace umov {

struct PassLight::State {
  std::vector<Band> bands;
  std::vector<double> solar; ///< irradiance at 1 au per band
  // A sphere:
  std::vector<BandResult> by_phase; ///< [step * bands + band], steps of half a degree
  // A body:
  std::optional<Integrator> integrator;
  std::optional<Engine> engine;
  std::size_t bounces = 1;
  AttitudeLaw attitude;
  std::vector<GlintFlat> flats;
};

namespace {

/// Magnitudes to a few hundredths: a range over a pass asks for no more.
IntegrationOptions pass_accuracy(std::size_t bounces) {
  IntegrationOptions out;
  out.bounces = bounces;
  out.accuracy = 0.02;
  out.max_points = 1u << 17;
  return out;
}

constexpr double phase_step_deg = 0.5;
constexpr std::size_t phase_steps = 361;

AttitudeContext context_of(const ObservingGeometry &g) {
  return {g.time, g.gcrs_km, g.gcrs_velocity_km_s, g.to_sun, g.to_observer};
}

double solar_radius(const ObservingGeometry &g) {
  return std::asin(constants::sun_radius_km / g.sun_distance_km);
}

Pose pose_of(const Rotation<Body, Gcrs> &body, const ObservingGeometry &g) {
  return {normalized(body * g.to_sun), normalized(body * g.to_observer), solar_radius(g)};
}

Result<Attitude> attitude_of(const AttitudeLaw &law, const Trajectory &orbit, const Site &site,
                             ShadowModel shadow) {
  return Attitude::make(law, [&](Epoch<Utc> time) {
    return orbit.at(time).map(
        [&](const TemeState &state) { return context_of(observe(state, time, site, shadow)); });
  });
}

std::vector<double> solar_of(const std::vector<Band> &bands) {
  std::vector<double> out;
  for (const Band &band : bands)
    out.push_back(solar_irradiance(band.wavelength).value_or(0));
  return out;
}

/// Largest rate at which the half vector moves in the body [rad/s]: how fast the body can turn by
/// itself, and how fast orbit and Earth turn the view (measured between samples, with a margin).
double rate_bound(const Attitude &attitude, std::span<const ObservingGeometry> samples) {
  double half = 0, pointing = 0;
  std::optional<Rotation<Body, Gcrs>> before;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto body = attitude.at(context_of(samples[k]));
    if (k > 0) {
      const ObservingGeometry &a = samples[k - 1], &b = samples[k];
      const double dt = std::max(std::abs(seconds_between(b.time, a.time)), 1e-3);
      const Vec3<Gcrs> h0 = a.to_sun + a.to_observer, h1 = b.to_sun + b.to_observer;
      if (norm(h0) > 1e-3 && norm(h1) > 1e-3)
        half = std::max(half, angle_between(h0, h1) / dt);
      if (body && before)
        for (int axis = 0; axis < 3; ++axis)
          pointing = std::max(pointing, angle_between(body->row(axis), before->row(axis)) / dt);
    }
    if (body)
      before = *body;
  }
  constexpr double margin = 2;
  const AttitudeRates rates = attitude.rates();
  return margin * half + rates.own_rad_s + (rates.follows_orbit ? margin * 1.5 * pointing : 0);
}

} // namespace

PassLight PassLight::of_body(const Scene &scene, const AttitudeLaw &attitude, bool is_for_many,
                             std::size_t bounces) {
  auto state = std::make_shared<State>();
  state->bands = scene.bands;
  state->solar = solar_of(scene.bands);
  state->attitude = attitude;
  state->integrator.emplace(scene);
  state->bounces = bounces;
  if ((is_for_many && bounces == 1) || state->integrator->is_convex())
    state->engine.emplace(scene, EngineOptions{});
  state->flats = glint_flats(scene);
  PassLight out;
  out.state_ = std::move(state);
  return out;
}

Result<PassLight> PassLight::of_sphere(double radius_m, const Material &material,
                                       const std::vector<Band> &bands) {
  Diagnostics unused;
  UMOV_ASSIGN(scene, make_scene(make_sphere(radius_m, 5000), NormalMode::Smooth, bands, {material},
                                {material}, unused));
  const Integrator integrator(scene);
  auto state = std::make_shared<State>();
  state->bands = bands;
  state->solar = solar_of(bands);
  for (std::size_t k = 0; k < phase_steps; ++k) {
    const double phase = Angle::degrees(phase_step_deg * static_cast<double>(k)).radians();
    Pose pose{{std::cos(phase), std::sin(phase), 0}, {1, 0, 0}, 0.2665 * pi / 180};
    const PoseResult light = integrator.evaluate(pose, {});
    state->by_phase.insert(state->by_phase.end(), light.bands.begin(), light.bands.end());
  }
  PassLight out;
  out.state_ = std::move(state);
  return out;
}

const std::vector<Band> &PassLight::bands() const { return state_->bands; }

namespace {

/// Takes one sample of light into the pass's ranges.
void take(const Stokes<ScatteringPlane> &s, const ObservingGeometry &g, const Band &band,
          double solar, SitePass &pass) {
  const double irradiance =
      irradiance_at_observer(s.i, solar, g.sun_distance_km, g.sunlit, g.range_km);
  if (!(irradiance > 0))
    return;
  const double magnitude = ab_magnitude(irradiance, band.wavelength);
  // fmin and fmax take the number where one of the two is none.
  pass.magnitude_min = std::fmin(pass.magnitude_min, magnitude);
  pass.magnitude_max = std::fmax(pass.magnitude_max, magnitude);
  pass.p_max = std::fmax(pass.p_max, std::hypot(s.q, s.u) / s.i);
}

} // namespace

Result<void> PassLight::describe(const Trajectory &orbit, const Site &site, ShadowModel shadow,
                                 std::size_t band, std::span<const ObservingGeometry> samples,
                                 SitePass &pass) const {
  const State &state = *state_;
  std::vector<ObservingGeometry> lit;
  for (const ObservingGeometry &g : samples)
    if (g.sunlit > 0)
      lit.push_back(g);
  if (lit.empty())
    return {};
  if (!state.by_phase.empty()) {
    for (const ObservingGeometry &g : lit) {
      const double at = g.phase_angle.degrees() / phase_step_deg;
      const auto k = std::min(static_cast<std::size_t>(at), phase_steps - 2);
      const double share = at - static_cast<double>(k);
      const auto &a = state.by_phase[k * state.bands.size() + band].stokes,
                 &b = state.by_phase[(k + 1) * state.bands.size() + band].stokes;
      take(a * (1 - share) + b * share, g, state.bands[band], state.solar[band], pass);
    }
    return {};
  }
  UMOV_ASSIGN(attitude, attitude_of(state.attitude, orbit, site, shadow));
  // Glints first: their peaks count for the range of magnitudes.
  const Epoch<Utc> origin = lit.front().time;
  const auto geometry_at = [&](double seconds) -> Result<ObservingGeometry> {
    const Epoch<Utc> time = plus_seconds(origin, seconds);
    return orbit.at(time).map(
        [&](const TemeState &teme) { return observe(teme, time, site, shadow); });
  };
  UMOV_ASSIGN(glints, find_glints(
                          state.flats,
                          [&](double seconds) -> Result<GlintView> {
                            UMOV_ASSIGN(g, geometry_at(seconds));
                            UMOV_ASSIGN(body, attitude.at(context_of(g)));
                            const Pose pose = pose_of(body, g);
                            return GlintView{pose.sun, pose.observer};
                          },
                          0, seconds_between(lit.back().time, origin), rate_bound(attitude, lit),
                          0.5 * solar_radius(lit.front())));
  for (const Glint &glint : glints) {
    UMOV_ASSIGN(g, geometry_at(glint.seconds));
    UMOV_ASSIGN(body, attitude.at(context_of(g)));
    const PoseResult light =
        state.integrator->evaluate(pose_of(body, g), pass_accuracy(state.bounces));
    if (!(g.sunlit > 0) || !(light.glint_share > 0.5))
      continue;
    pass.glints.push_back({g.time, glint.width_s});
    lit.push_back(g);
  }
  std::vector<Pose> poses;
  for (const ObservingGeometry &g : lit) {
    UMOV_ASSIGN(body, attitude.at(context_of(g)));
    poses.push_back(pose_of(body, g));
  }
  const auto take_all = [&](const auto &stokes_of) {
    for (std::size_t k = 0; k < poses.size(); ++k)
      take(stokes_of(k), lit[k], state.bands[band], state.solar[band], pass);
  };
  if (state.engine) {
    StokesTable table;
    state.engine->evaluate(poses, table);
    take_all([&](std::size_t k) { return table.at(k, band).stokes; });
  } else {
    const auto light = state.integrator->evaluate(poses, pass_accuracy(state.bounces), 1);
    take_all([&](std::size_t k) { return light[k].bands[band].stokes; });
  }
  return {};
}

} // namespace umov
