#include <umov/lightcurve/pass_light.h>

#include <algorithm>
#include <cmath>
#include <umov/light/light_model.h>
#include <umov/observation/track.h>
#include <umov/photometry/radiometry.h>
#include <umov/shape/primitives.h>

namespace umov {

struct PassLight::State {
  std::vector<Band> bands;
  std::vector<double> solar; ///< irradiance at 1 au per band
  // A sphere:
  std::vector<Stokes<ScatteringPlane>> by_phase; ///< [step * bands + band], steps of half a degree
  // A body:
  std::unique_ptr<LightModel> light;  ///< for all samples
  std::unique_ptr<LightModel> glints; ///< for those that say whether a flat gives most of the light
  AttitudeLaw attitude;
  std::vector<GlintFlat> flats;
};

namespace {

/// Magnitudes to a few hundredths: a range over a pass asks for no more.
LightOptions pass_accuracy(LightMethod method, std::size_t bounces) {
  LightOptions out;
  out.method = method;
  out.bounces = bounces;
  out.accuracy = 0.02;
  out.max_points = 1u << 17;
  return out;
}

constexpr double phase_step_deg = 0.5;
constexpr std::size_t phase_steps = 361;

} // namespace

Result<PassLight> PassLight::of_body(const Scene &scene, const AttitudeLaw &attitude,
                                     LightMethod method, std::size_t bounces) {
  auto state = std::make_shared<State>();
  state->bands = scene.bands;
  UMOV_ASSIGN(solar, solar_irradiances(scene.bands));
  state->solar = std::move(solar);
  state->attitude = attitude;
  UMOV_ASSIGN(light, make_light(scene, {}, pass_accuracy(method, bounces)));
  state->light = std::move(light);
  if (method == LightMethod::Masks) {
    UMOV_ASSIGN(glints, make_light(scene, {}, pass_accuracy(LightMethod::Rays, bounces)));
    state->glints = std::move(glints);
  }
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
  auto state = std::make_shared<State>();
  state->bands = bands;
  UMOV_ASSIGN(solar, solar_irradiances(bands));
  state->solar = std::move(solar);
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < phase_steps; ++k) {
    const double phase = Angle::degrees(phase_step_deg * static_cast<double>(k)).radians();
    poses.push_back({{std::cos(phase), std::sin(phase), 0}, {1, 0, 0}, sun_radius_at_1au_rad});
  }
  LightOptions options;
  options.method = LightMethod::Rays;
  UMOV_ASSIGN(light, make_light(scene, {}, options));
  StokesTable table;
  (void)light->evaluate(poses, table);
  for (std::size_t k = 0; k < phase_steps; ++k)
    for (std::size_t b = 0; b < bands.size(); ++b)
      state->by_phase.push_back(table.at(k, b).stokes);
  PassLight out;
  out.state_ = std::move(state);
  return out;
}

const std::vector<Band> &PassLight::bands() const { return state_->bands; }

namespace {

/// Takes one sample of light into the pass's ranges.
void take(const Stokes<ScatteringPlane> &s, const ObservingGeometry &g, const Band &band,
          double solar, SitePass &pass) {
  const ObservedLight observed =
      observed_light(s.i, band, solar, {g.sun_distance_km, g.range_km, g.sunlit});
  if (!(observed.irradiance > 0))
    return;
  const double magnitude = observed.magnitude;
  // fmin and fmax take the number where one of the two is none.
  pass.magnitude_min = std::fmin(pass.magnitude_min, magnitude);
  pass.magnitude_max = std::fmax(pass.magnitude_max, magnitude);
  pass.p_max = std::fmax(pass.p_max, std::hypot(s.q, s.u) / s.i);
}

} // namespace

/// Glints of flats that give more than half of the light then; their geometries join `lit`.
Result<void> PassLight::add_glints(const State &state, const Track &track,
                                   std::vector<ObservingGeometry> &lit, SitePass &pass) {
  const Epoch<Utc> origin = lit.front().time;
  const GlintPath path = [&](double seconds) -> Result<GlintView> {
    UMOV_ASSIGN(point, track.at(plus_seconds(origin, seconds)));
    return GlintView{point.pose.sun, point.pose.observer};
  };
  UMOV_ASSIGN(glints, find_glints(state.flats, path, 0, seconds_between(lit.back().time, origin),
                                  track.half_vector_rate(lit), 0.5 * sun_radius_rad(lit.front())));
  LightTask task;
  task.has_glints = true;
  task.threads = 1;
  for (const Glint &glint : glints) {
    UMOV_ASSIGN(point, track.at(plus_seconds(origin, glint.seconds)));
    StokesTable table;
    (void)(state.glints ? state.glints : state.light)->evaluate({&point.pose, 1}, table, task);
    if (!(point.geometry.sunlit > 0) || !(table.glint_share[0] > 0.5))
      continue;
    pass.glints.push_back({point.geometry.time, glint.width_s});
    lit.push_back(point.geometry);
  }
  return {};
}

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
      const auto &a = state.by_phase[k * state.bands.size() + band],
                 &b = state.by_phase[(k + 1) * state.bands.size() + band];
      take(a * (1 - share) + b * share, g, state.bands[band], state.solar[band], pass);
    }
    return {};
  }
  UMOV_ASSIGN(track, Track::make({orbit, site, shadow, state.attitude, {}, true}));
  UMOV_TRY(add_glints(state, track, lit, pass)); // first: their peaks count for the magnitudes
  std::vector<Pose> poses;
  for (const ObservingGeometry &g : lit) {
    UMOV_ASSIGN(point, track.place(g));
    poses.push_back(point.pose);
  }
  StokesTable table;
  LightTask task;
  task.threads = 1; // objects are side by side
  (void)state.light->evaluate(poses, table, task);
  for (std::size_t k = 0; k < poses.size(); ++k)
    take(table.at(k, band).stokes, lit[k], state.bands[band], state.solar[band], pass);
  return {};
}

} // namespace umov
