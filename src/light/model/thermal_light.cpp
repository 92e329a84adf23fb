#include "light/model/ray_tracer.h"
#include "light/unless_stopped.h"

#include <umov/core/parallel.h>
#include <umov/core/stop.h>
#include <umov/light/thermal.h>

namespace umov {
namespace {

/// The body's own heat, by paths.
class ThermalLight final : public LightModel {
public:
  ThermalLight(const Scene &of, std::vector<Joint> turning, ThermalEmission emission,
               const LightOptions &options, const std::atomic<bool> *cancel)
      : LightModel(of, std::move(turning)), emission_(std::move(emission)),
        options_(integration_of(options, {})), integrator_(scene(), cancel) {
    facts_.method = LightMethod::Rays;
    facts_.is_convex = joints().empty() && integrator_.is_convex();
    facts_.instruction_set = "scalar double";
    if (options.device.choice == DeviceChoice::Auto)
      facts_.device = "cpu: own heat is lit by the processor";
    facts_.visibility = "paths";
  }

private:
  bool light(std::span<const Pose> poses, std::span<const double> angles_rad, StokesTable &out,
             const LightTask &task) const override {
    return unless_stopped(task.cancel, [&] { return light_now(poses, angles_rad, out, task); });
  }

  bool light_now(std::span<const Pose> poses, std::span<const double> angles_rad, StokesTable &out,
                 const LightTask &task) const {
    out.resize(poses.size(), scene().grid.nodes().size());
    out.glint_share.assign(task.has_glints ? poses.size() : 0, 0); // heat has none
    out.material_i.assign(task.has_materials ? poses.size() * materials().size() * out.bands : 0,
                          0);
    const auto found = emitted(poses, angles_rad, task);
    if (is_stopped(task.cancel) || found.size() < poses.size())
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

  [[nodiscard]] std::vector<IndirectLight> emitted(std::span<const Pose> poses,
                                                   std::span<const double> angles_rad,
                                                   const LightTask &task) const {
    if (joints().empty())
      return integrator_.thermal(poses, emission_, options_, task.threads, task.cancel);
    std::vector<IndirectLight> out(poses.size());
    parallel_for(poses.size(), task.threads, [&](std::size_t k) {
      if (is_stopped(task.cancel))
        return;
      auto one = Integrator(turned(scene(), joints(), angles_rad, k), task.cancel)
                     .thermal(poses.subspan(k, 1), emission_, options_, 1, task.cancel);
      if (!one.empty())
        out[k] = std::move(one.front());
    });
    return out;
  }

  ThermalEmission emission_;
  IntegrationOptions options_;
  Integrator integrator_;
};

} // namespace

Result<std::unique_ptr<LightModel>> make_thermal_light(const Scene &scene,
                                                       std::vector<Joint> joints,
                                                       std::span<const double> temperature_k,
                                                       const LightOptions &options,
                                                       const std::atomic<bool> *cancel) {
  return without_failures([&]() -> Result<std::unique_ptr<LightModel>> {
    UMOV_ASSIGN(emission, ThermalEmission::make(scene, temperature_k, cancel));
    return std::make_unique<ThermalLight>(scene, std::move(joints), std::move(emission), options,
                                          cancel);
  });
}

} // namespace umov
