#include <umov/light/light_model.h>

#include <algorithm>
#include <umov/core/expects.h>

namespace umov {

std::vector<std::string> material_names(const Scene &scene) {
  std::vector<std::string> out;
  for (const auto *side : {&scene.front, &scene.back})
    for (const Surface &surface : *side)
      if (std::find(out.begin(), out.end(), surface.material().name) == out.end())
        out.push_back(surface.material().name);
  return out;
}

LightModel::LightModel(const Scene &scene, std::vector<Joint> joints)
    : scene_(scene), joints_(std::move(joints)), materials_(material_names(scene)) {
  facts_.triangles = scene.mesh.triangles.size();
}

bool LightModel::evaluate(std::span<const Pose> poses, std::span<const double> angles_rad,
                          StokesTable &out, const LightTask &task) const {
  UMOV_EXPECTS(angles_rad.size() == poses.size() * joints_.size());
  return light(poses, angles_rad, out, task);
}

bool LightModel::evaluate(std::span<const Pose> poses, StokesTable &out,
                          const LightTask &task) const {
  const std::vector<double> still(poses.size() * joints_.size(), 0);
  return evaluate(poses, still, out, task);
}

} // namespace umov
