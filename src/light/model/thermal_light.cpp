#include "light/model/ray_tracer.h"

#include <umov/light/thermal.h>

namespace umov {
namespace {

/// The body's own heat, by paths.
class ThermalLight final : public LightModel {
public:
  ThermalLight(const Scene &of, ThermalEmission emission, const LightOptions &options)
      : LightModel(of, {}), emission_(std::move(emission)), options_(integration_of(options, {})),
        integrator_(scene()) {
    facts_.method = LightMethod::Rays;
    facts_.is_convex = integrator_.is_convex();
    facts_.instruction_set = "scalar double";
    facts_.visibility = "paths";
  }

private:
  bool light(std::span<const Pose> poses, std::span<const double>, StokesTable &out,
             const LightTask &task) const override {
    out.resize(poses.size(), scene().bands.size());
    const auto found = integrator_.thermal(poses, emission_, options_, task.threads, task.cancel);
    if (is_cancelled(task) || found.size() < poses.size())
      return false;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      out.method[k] = PoseMethod::Rays;
      out.is_dark[k] = 1;
      for (std::size_t b = 0; b < out.bands; ++b) {
        out.put(k, b, found[k].bands[b]);
        if (found[k].bands[b].stokes.i > 0)
          out.is_dark[k] = 0;
      }
    }
    return true;
  }

  ThermalEmission emission_;
  IntegrationOptions options_;
  Integrator integrator_;
};

} // namespace

Result<std::unique_ptr<LightModel>> make_thermal_light(const Scene &scene,
                                                       std::span<const double> temperature_k,
                                                       const LightOptions &options) {
  UMOV_ASSIGN(emission, ThermalEmission::make(scene, temperature_k));
  return std::make_unique<ThermalLight>(scene, std::move(emission), options);
}

} // namespace umov
