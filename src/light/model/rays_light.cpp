#include "light/model/models.h"

#include <numeric>

namespace umov {

RaysLight::RaysLight(const Scene &of, std::vector<Joint> turning, const LightOptions &options,
                     const std::vector<double> &typical_i, const std::atomic<bool> *cancel,
                     ChainSharing chains)
    : LightModel(of, std::move(turning)),
      rays_(scene(), joints(), integration_of(options, floor_of(options, typical_i)), materials(),
            std::move(chains)) {
  facts_.floor_i = of_bands(floor_of(options, typical_i));
  facts_.method = LightMethod::Rays;
  facts_.is_convex = rays_.is_convex(cancel);
  facts_.instruction_set = "scalar double";
  if (options.device.choice == DeviceChoice::Auto)
    facts_.device = "cpu: rays are traced by the processor";
  facts_.visibility = facts_.is_convex ? "none: the mesh is convex" : "rays";
}

bool RaysLight::light(std::span<const Pose> poses, std::span<const double> angles_rad,
                      StokesTable &out, const LightTask &task) const {
  out.resize(poses.size(), scene().grid.nodes().size());
  if (task.has_glints)
    out.glint_share.assign(poses.size(), 0);
  if (task.has_materials)
    out.material_i.assign(out.i.size() * materials().size(), 0);
  std::vector<std::size_t> all(poses.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return rays_.light(poses, angles_rad, all, out, task);
}

} // namespace umov
