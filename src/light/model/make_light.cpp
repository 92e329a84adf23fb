// The one place that decides how a scene is lit.

#include "light/model/models.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <umov/light/poses.h>
#include <umov/shape/topology.h>

namespace umov {

namespace {

/// Random poses that belong to the object alone, phase angles even over 30 to 150 deg.
std::vector<Pose> typical_poses(std::size_t count) {
  constexpr std::uint64_t seed = 0;
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < count; ++k) {
    const double phase = 30 + 120 * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    poses.push_back(random_pose(seed, k, Angle::degrees(phase)));
    poses.back().sun_radius_rad = sun_radius_at_1au_rad;
  }
  return poses;
}

StokesTable lit_by(const Engine &engine, const std::vector<Pose> &poses,
                   const std::atomic<bool> *cancel) {
  StokesTable out;
  LightTask task;
  task.threads = 1;
  task.cancel = cancel;
  (void)engine.evaluate(poses, out, task);
  leave_if_stopped(cancel);
  return out;
}

Engine unhidden_engine(const Scene &scene, const std::atomic<bool> *cancel) {
  return Engine(scene, {.visibility = Visibility::None, .threads = 1}, cancel);
}

std::vector<double> typical_light(const Engine &unhidden, const std::atomic<bool> *cancel) {
  constexpr std::size_t count = 256;
  const StokesTable table = lit_by(unhidden, typical_poses(count), cancel);
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

/// Masks hold for sunlight. A convex body needs no rays: its light by the reference is exact, where
/// the engine's joined normals err by more than their half-widths tell.
bool takes_rays(const Scene &scene, const std::vector<Joint> &joints, const LightOptions &options,
                const std::atomic<bool> *cancel) {
  if (options.method == LightMethod::Rays || !is_sunlight(options.source))
    return true;
  return options.method == LightMethod::Auto && joints.empty() &&
         is_proven_convex(scene.mesh, cancel);
}

} // namespace

std::vector<double> typical_light(const Scene &scene, const std::atomic<bool> *cancel) {
  return typical_light(unhidden_engine(scene, cancel), cancel);
}

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

const char *name_of(BetweenMethod method) {
  switch (method) {
  case BetweenMethod::Auto:
    return "auto";
  case BetweenMethod::Paths:
    return "paths";
  case BetweenMethod::Chains:
    return "chains";
  }
  return "";
}

LightOptions for_many_poses(LightOptions options) {
  if (options.method != LightMethod::Auto || options.bounces > 1)
    return options;
  options.accuracy = 0.05;
  options.accuracy_floor = options.accuracy_floor.value_or(0.02);
  options.is_for_many_poses = true;
  return options;
}

double default_accuracy_floor(LightMethod method) { return method == LightMethod::Auto ? 0.1 : 0; }

namespace {

Result<void> check(const LightOptions &options) {
  const auto refuse = [](const char *what, double found, const char *expected) {
    return fail(ErrorCode::BadInput,
                fmt::format("{} is {}; {} was expected", what, found, expected));
  };
  if (!(options.accuracy > 0 && options.accuracy <= 1))
    return refuse("accuracy", options.accuracy, "a number above 0, up to 1,");
  if (const double floor = options.accuracy_floor.value_or(0);
      !(floor >= 0 && std::isfinite(floor)))
    return refuse("accuracy_floor", floor, "0 or more");
  if (options.bounces < 1 || options.bounces > 64)
    return refuse("bounces", static_cast<double>(options.bounces), "1 to 64");
  return {};
}

} // namespace

namespace {

/// As make_light; throws what keeps an engine from being made.
Result<std::unique_ptr<LightModel>> make(const Scene &scene, std::vector<Joint> joints,
                                         const LightOptions &options,
                                         const std::atomic<bool> *cancel, ChainFamily family) {
  const auto begin = std::chrono::steady_clock::now();
  UMOV_TRY(check(options));
  ChainSharing chains;
  if (options.bounces > 1 && joints.empty() && options.between == BetweenMethod::Chains) {
    chains.also = std::move(family.also);
    if (family.elder && !family.elder->facts().is_convex)
      chains.elder = family.elder->chain_drawer(cancel);
  }
  const bool has_rays = takes_rays(scene, joints, options, cancel);
  if (has_rays && options.device.choice == DeviceChoice::Cuda)
    return fail(ErrorCode::Usage, "rays are traced by the processor, and cards add up what masks "
                                  "tell: take render.method = \"masks\" (--visibility masks of "
                                  "signature and invert; a convex body needs it too), or --device "
                                  "cpu");
  std::vector<double> typical_i;
  std::optional<Engine> unhidden;
  const bool has_widths = options.has_half_widths || options.method == LightMethod::Auto;
  if ((!has_rays && has_widths) || options.accuracy_floor.value_or(0) > 0)
    typical_i = typical_light(unhidden.emplace(unhidden_engine(scene, cancel)), cancel);
  if (!options.mask_file.empty() && !joints.empty())
    return fail(ErrorCode::BadInput,
                fmt::format("{} cannot hold the masks: each part that turns has "
                            "its own. Leave the file out; the cache keeps them.",
                            options.mask_file.string()));
  if (has_rays)
    return std::make_unique<RaysLight>(scene, std::move(joints), options, typical_i, cancel,
                                       std::move(chains));
  return MasksLight::make(scene, std::move(joints), options, typical_i,
                          has_widths ? &*unhidden : nullptr, begin, cancel, std::move(chains));
}

} // namespace

Result<std::unique_ptr<LightModel>> make_light(const Scene &scene, std::vector<Joint> joints,
                                               const LightOptions &options,
                                               const std::atomic<bool> *cancel,
                                               ChainFamily family) {
  return without_failures(
      [&] { return make(scene, std::move(joints), options, cancel, std::move(family)); });
}

Result<std::unique_ptr<LightModel>> make_light_for_many(const Scene &scene,
                                                        std::vector<Joint> joints,
                                                        LightOptions options,
                                                        const std::atomic<bool> *cancel) {
  options.method = LightMethod::Masks;
  options.bounces = 1;
  return make_light(scene, std::move(joints), options, cancel);
}

} // namespace umov
