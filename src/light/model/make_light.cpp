// The one place that decides how a scene is lit.

#include "light/model/models.h"

#include <algorithm>
#include <umov/light/poses.h>
#include <umov/shape/topology.h>

namespace umov {

std::vector<double> typical_light(const Scene &scene) {
  constexpr std::size_t count = 256;
  constexpr std::uint64_t seed = 0; // of the object alone
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < count; ++k) {
    const double phase = 30 + 120 * (static_cast<double>(k) + 0.5) / count;
    poses.push_back(random_pose(seed, k, Angle::degrees(phase)));
    poses.back().sun_radius_rad = sun_radius_at_1au_rad;
  }
  StokesTable table;
  Engine(scene, {.visibility = Visibility::None, .threads = 1}).evaluate(poses, table);
  std::vector<double> out;
  for (std::size_t b = 0; b < table.bands; ++b) {
    std::vector<double> light;
    for (std::size_t k = 0; k < count; ++k)
      light.push_back(table.i[k * table.bands + b]);
    std::nth_element(light.begin(), light.begin() + count / 2, light.end());
    out.push_back(light[count / 2]);
  }
  return out;
}

namespace {

bool is_sunlight(const Stokes<ScatteringPlane> &source) {
  return source.i == 1 && source.q == 0 && source.u == 0 && source.v == 0;
}

/// Masks hold for sunlight. A convex body needs no rays: its light by the reference is exact, where
/// the engine's joined normals err by more than their half-widths tell.
bool takes_rays(const Scene &scene, const std::vector<Joint> &joints, const LightOptions &options) {
  if (options.method == LightMethod::Rays || !is_sunlight(options.source))
    return true;
  return options.method == LightMethod::Auto && joints.empty() && is_proven_convex(scene.mesh);
}

} // namespace

std::vector<double> floor_of(const LightOptions &options, const std::vector<double> &typical_i) {
  const double part = options.accuracy_floor.value_or(default_accuracy_floor(options.method));
  std::vector<double> out;
  if (part > 0)
    for (const double light : typical_i)
      out.push_back(part * light);
  return out;
}

const char *name_of(LightMethod method) {
  switch (method) {
  case LightMethod::Rays:
    return "rays";
  case LightMethod::Masks:
    return "masks";
  case LightMethod::Auto:
    return "auto";
  }
  return "";
}

double default_accuracy_floor(LightMethod method) { return method == LightMethod::Auto ? 0.1 : 0; }

Result<std::unique_ptr<LightModel>> make_light(const Scene &scene, std::vector<Joint> joints,
                                               const LightOptions &options) {
  std::vector<double> typical_i;
  if (options.method == LightMethod::Auto || options.accuracy_floor.value_or(0) > 0)
    typical_i = typical_light(scene);
  if (!takes_rays(scene, joints, options))
    return MasksLight::make(scene, std::move(joints), options, std::move(typical_i));
  return std::make_unique<RaysLight>(scene, std::move(joints), options, typical_i);
}

Result<std::unique_ptr<LightModel>>
make_light_for_many(const Scene &scene, std::vector<Joint> joints, LightOptions options) {
  options.method = LightMethod::Masks;
  options.bounces = 1;
  return make_light(scene, std::move(joints), options);
}

} // namespace umov
