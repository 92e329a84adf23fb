#include <umov/lightcurve/pass_light.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <umov/core/stop.h>
#include <umov/light/light_model.h>
#include <umov/light/point_budget.h>
#include <umov/lightcurve/shown_magnitude.h>
#include <umov/observation/track.h>
#include <umov/photometry/radiometry.h>
#include <umov/shape/primitives.h>

namespace umov {

struct PassLight::State {
  std::vector<PhotometricBand> bands;
  // A sphere:
  std::vector<Stokes<ScatteringPlane>> by_phase; ///< [step * bands + band], steps of half a degree
  // A body:
  std::unique_ptr<LightModel> light;
  AttitudeLaw attitude;
  std::vector<MovingJoint> joints;
  bool has_solar_disk = true;
  std::vector<std::vector<GlintFlat>> flats; ///< of each joint's part, then of what stands still
  std::optional<SiteAir> air;
};

namespace {

constexpr const char *stopped = "stopped by the user in the middle of a pass";
constexpr double phase_step_deg = 0.5;
constexpr std::size_t phase_steps = 361;

} // namespace

LightOptions pass_light_options(LightMethod method) {
  LightOptions out;
  out.method = method;
  out.accuracy = 0.02;
  out.max_points = most_points::over_a_pass;
  return out;
}

Result<PassLight> PassLight::of_body(PassBody body, const LightOptions &options,
                                     const std::atomic<bool> *cancel) {
  return without_failures([&]() -> Result<PassLight> {
    auto state = std::make_shared<State>();
    UMOV_ASSIGN(colours, photometric_bands(body.scene.bands, body.magnitudes));
    state->bands = std::move(colours);
    state->attitude = body.attitude;
    state->has_solar_disk = body.has_solar_disk;
    state->air = body.air;
    const std::vector<Joint> joints = joints_of(body.joints);
    const std::vector<std::size_t> part_of = joint_of_groups(body.scene.mesh, joints);
    state->flats.resize(joints.size() + 1);
    for (const GlintFlat &flat : glint_flats(body.scene, 0.02, widest_glint_rad, cancel))
      state->flats[part_of[flat.group]].push_back(flat);
    state->joints = std::move(body.joints);
    UMOV_ASSIGN(light, make_light(body.scene, joints, options, cancel));
    state->light = std::move(light);
    PassLight out;
    out.state_ = std::move(state);
    return out;
  });
}

Result<PassLight> PassLight::of_sphere(double radius_m, const Material &material,
                                       const std::vector<Band> &bands) {
  Diagnostics unused;
  UMOV_ASSIGN(scene, make_scene(make_sphere(radius_m, 5000), NormalMode::Smooth, bands, {material},
                                {material}, unused));
  auto state = std::make_shared<State>();
  UMOV_ASSIGN(colours, photometric_bands(bands, MagnitudeSystem::AB));
  state->bands = std::move(colours);
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

Result<void> PassLight::keep_masks() const {
  return state_->light ? state_->light->keep_masks() : Result<void>();
}

namespace {

/// Takes one sample of light into the pass's ranges, as far as it is known. `share`: of it that the
/// air lets through; NaN: not asked for.
void take(const PassSample &sample, const PhotometricBand &band, double share,
          PassBrightness &pass) {
  if (sample.is_dark)
    return;
  const ObservingGeometry &g = sample.geometry;
  const auto &[s, half_width] = sample.light;
  const auto [magnitude, is_limit] =
      shown_magnitude(sample.light, band, {g.sun_distance_km, g.range_km, g.sunlit});
  // fmin and fmax take the number where one of the two is none.
  const double behind = std::min(magnitude - 2.5 * std::log10(share), faintest_magnitude);
  pass.magnitude_max = std::fmax(pass.magnitude_max, magnitude);
  pass.magnitude_obs_max = std::fmax(pass.magnitude_obs_max, behind);
  if (is_limit) {
    pass.has_limit = true;
    return;
  }
  if (!pass.brightest || magnitude < pass.magnitude_min)
    pass.brightest = g.time;
  pass.magnitude_min = std::fmin(pass.magnitude_min, magnitude);
  pass.magnitude_obs_min = std::fmin(pass.magnitude_obs_min, behind);
  if (is_p_known(s.i, half_width))
    pass.p_max = std::fmax(pass.p_max, std::hypot(s.q, s.u) / s.i);
}

} // namespace

/// Glints of flats that give more than half of the light then; their geometries join `lit`.
Result<std::vector<PassGlint>> PassLight::glints_of(const State &state, const Track &track,
                                                    const std::atomic<bool> *cancel,
                                                    std::vector<ObservingGeometry> &lit) {
  std::vector<PassGlint> out;
  const Epoch<Utc> origin = lit.front().time;
  const std::vector<Joint> &joints = state.light->joints();
  const double last_s = seconds_between(lit.back().time, origin);
  const double rate = track.half_vector_rate(lit), half_disk = 0.5 * sun_radius_rad(lit.front());
  std::vector<Glint> all;
  for (std::size_t part = 0; part < state.flats.size(); ++part) {
    if (state.flats[part].empty())
      continue;
    const GlintPath path = [&, part](double seconds) -> Result<GlintView> {
      if (is_stopped(cancel)) // up to millions of times
        return fail(ErrorCode::Interrupted, stopped);
      UMOV_ASSIGN(point, track.at(plus_seconds(origin, seconds)));
      if (part == joints.size())
        return GlintView{point.pose.sun, point.pose.observer};
      const auto back = part_motions(joints, point.joint_angles_rad)[part].turn.inverse();
      return GlintView{back * point.pose.sun, back * point.pose.observer};
    };
    UMOV_ASSIGN(found, find_glints(state.flats[part], path, 0, last_s, rate, half_disk));
    all.insert(all.end(), found.begin(), found.end());
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Glint &a, const Glint &b) { return a.seconds < b.seconds; });
  LightTask task;
  task.has_glints = true;
  task.threads = 1;
  task.cancel = cancel;
  for (const Glint &glint : all) {
    UMOV_ASSIGN(point, track.at(plus_seconds(origin, glint.seconds)));
    StokesTable table;
    if (!state.light->evaluate({&point.pose, 1}, point.joint_angles_rad, table, task))
      return fail(ErrorCode::Interrupted, stopped);
    if (!(point.geometry.sunlit > 0) || !(table.glint_share[0] > 0.5))
      continue;
    out.push_back({point.geometry.time, glint.width_s});
    lit.push_back(point.geometry);
  }
  return out;
}

/// The light of a body at some of a pass's epochs.
Result<std::vector<PassSample>> PassLight::light_of(const State &state, const Track &track,
                                                    std::size_t band,
                                                    std::span<const ObservingGeometry> at,
                                                    const std::atomic<bool> *cancel) {
  std::vector<Pose> poses;
  std::vector<double> angles;
  for (const ObservingGeometry &g : at) {
    UMOV_ASSIGN(point, track.place(g));
    poses.push_back(point.pose);
    angles.insert(angles.end(), point.joint_angles_rad.begin(), point.joint_angles_rad.end());
  }
  StokesTable table;
  LightTask task;
  task.threads = 1; // objects are side by side
  task.cancel = cancel;
  if (!state.light->evaluate(poses, angles, table, task))
    return fail(ErrorCode::Interrupted, stopped);
  std::vector<PassSample> out;
  for (std::size_t k = 0; k < poses.size(); ++k)
    out.push_back({at[k], table.at(k, band), table.is_dark[k] != 0});
  return out;
}

namespace {

/// Irradiance of a sample, or 0 where its light is not known.
double brightness(const PassSample &sample, const PhotometricBand &band) {
  const auto &[s, half_width] = sample.light;
  const ObservingGeometry &g = sample.geometry;
  const double out =
      observed_light(s.i, band, {g.sun_distance_km, g.range_km, g.sunlit}).irradiance;
  return out > 0 && is_known(s.i, half_width) ? out : 0;
}

/// Sunlit epochs on both sides of the `most` brightest tops of samples in order of time, six to
/// each step.
Result<std::vector<ObservingGeometry>> beside_tops(const std::vector<PassSample> &samples,
                                                   const PhotometricBand &band, const Track &track,
                                                   std::size_t most) {
  constexpr int parts = 7;
  constexpr double shortest_s = 0.05; // steps that light hardly changes in
  std::vector<double> value;
  for (const PassSample &sample : samples)
    value.push_back(brightness(sample, band));
  std::vector<std::size_t> tops;
  for (std::size_t k = 0; k < value.size(); ++k)
    if (value[k] > 0 && (k == 0 || value[k] >= value[k - 1]) &&
        (k + 1 == value.size() || value[k] > value[k + 1]))
      tops.push_back(k);
  std::ranges::stable_sort(tops, [&](std::size_t a, std::size_t b) { return value[a] > value[b]; });
  tops.resize(std::min(tops.size(), most));
  std::set<std::size_t> steps; // by their first sample; two tops may share one
  for (const std::size_t k : tops) {
    if (k > 0)
      steps.insert(k - 1);
    if (k + 1 < value.size())
      steps.insert(k);
  }
  std::vector<ObservingGeometry> out;
  for (const std::size_t k : steps) {
    const Epoch<Utc> from = samples[k].geometry.time;
    const double length = seconds_between(samples[k + 1].geometry.time, from);
    for (int part = 1; part < parts && length > shortest_s; ++part) {
      UMOV_ASSIGN(at, track.observe(plus_seconds(from, length * part / parts)));
      if (at.sunlit > 0)
        out.push_back(at);
    }
  }
  return out;
}

bool is_earlier(const ObservingGeometry &a, const ObservingGeometry &b) {
  return seconds_between(a.time, b.time) < 0;
}

} // namespace

Result<PassBrightness> PassLight::describe(const Trajectory &orbit, const Site &site,
                                           ShadowModel shadow, std::size_t band,
                                           std::span<const ObservingGeometry> samples,
                                           const std::atomic<bool> *cancel) const {
  const State &state = *state_;
  PassBrightness pass;
  std::vector<ObservingGeometry> lit;
  for (const ObservingGeometry &g : samples)
    if (g.sunlit > 0)
      lit.push_back(g);
  if (lit.empty())
    return pass;
  if (!state.by_phase.empty()) {
    for (const ObservingGeometry &g : lit) {
      const double at = g.phase_angle.degrees() / phase_step_deg;
      const auto k = std::min(static_cast<std::size_t>(at), phase_steps - 2);
      const double share = at - static_cast<double>(k);
      const auto &a = state.by_phase[k * state.bands.size() + band],
                 &b = state.by_phase[(k + 1) * state.bands.size() + band];
      take({g, {a * (1 - share) + b * share, {}}}, state.bands[band],
           std::numeric_limits<double>::quiet_NaN(), pass);
    }
    return pass;
  }
  UMOV_ASSIGN(track, Track::make({orbit, site, shadow, state.attitude, state.joints,
                                  state.has_solar_disk}));
  // First: their peaks count for the magnitudes.
  UMOV_ASSIGN(glints, glints_of(state, track, cancel, lit));
  pass.glints = std::move(glints);
  std::ranges::stable_sort(lit, is_earlier);
  UMOV_ASSIGN(seen, light_of(state, track, band, lit, cancel));
  // Tops of the samples first, then the brightest of what they turned out to be.
  for (const std::size_t most : {8u, 1u}) {
    UMOV_ASSIGN(between, beside_tops(seen, state.bands[band], track, most));
    UMOV_ASSIGN(more, light_of(state, track, band, between, cancel));
    seen.insert(seen.end(), more.begin(), more.end());
    std::ranges::stable_sort(seen, is_earlier, &PassSample::geometry);
  }
  for (const PassSample &sample : seen)
    take(sample, state.bands[band],
         state.air ? band_transmission(state.light->scene().grid, band, air_over(*state.air, site),
                                       sample.geometry.altitude)
                   : std::numeric_limits<double>::quiet_NaN(),
         pass);
  return pass;
}

} // namespace umov
