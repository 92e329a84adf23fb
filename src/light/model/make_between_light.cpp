#include <umov/light/between_light.h>

namespace umov {
namespace {

class SampledBetweenLight final : public BetweenLight {
public:
  SampledBetweenLight(const Scene &scene, const std::atomic<bool> *cancel)
      : integrator_(scene, cancel) {}

  [[nodiscard]] std::vector<Stokes<ScatteringPlane>> radiance(const Pose &pose,
                                                              std::span<const SurfacePoint> points,
                                                              const BetweenLightOptions &options,
                                                              std::uint64_t first) const override {
    IntegrationOptions integration;
    integration.bounces = options.bounces;
    integration.seed = options.seed;
    return integrator_.indirect_radiance(pose, points, integration, options.paths, first,
                                         options.cancel);
  }

private:
  Integrator integrator_;
};

} // namespace

std::unique_ptr<BetweenLight> make_between_light(const Scene &scene,
                                                 const std::atomic<bool> *cancel) {
  return std::make_unique<SampledBetweenLight>(scene, cancel);
}

} // namespace umov
