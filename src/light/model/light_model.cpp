#include <umov/light/light_model.h>

#include "light/model/band_sums.h"

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

namespace {

/// As many as a block of poses has at most (131,072), in as much memory as this for the light at
/// all wavelengths; no fewer than the longest block that shares paths, and a multiple of it.
std::size_t poses_at_a_time(std::size_t nodes, std::size_t materials) {
  constexpr std::size_t room = std::size_t{256} << 20, least = 4096, most = 131'072;
  constexpr std::size_t columns = 12; // I Q U V, their half-widths, and what is indirect of them
  const std::size_t row = nodes * (columns + materials) * sizeof(double);
  return std::clamp(room / row / least * least, least, most);
}

} // namespace

bool LightModel::evaluate(std::span<const Pose> poses, std::span<const double> angles_rad,
                          StokesTable &out, const LightTask &task) const {
  UMOV_EXPECTS(angles_rad.size() == poses.size() * joints_.size());
  if (scene_.grid.is_plain())
    return light(poses, angles_rad, out, task);
  // In parts: there are tens of wavelengths for each band. Those that share paths stay together,
  // and cards want tens of thousands at a time (docs/theory/device.md).
  const std::size_t part = poses_at_a_time(scene_.grid.nodes().size(), materials_.size());
  StokesTable nodes;
  for (std::size_t begin = 0; begin == 0 || begin < poses.size(); begin += part) {
    const std::size_t count = std::min(part, poses.size() - begin);
    if (!light(poses.subspan(begin, count),
               angles_rad.subspan(begin * joints_.size(), count * joints_.size()), nodes, task))
      return false;
    if (begin == 0)
      size_as(nodes, scene_.grid, poses.size(), materials_.size(), out);
    sum_bands(nodes, scene_.grid, materials_.size(), begin, task.threads, out);
  }
  return true;
}

bool LightModel::evaluate_at_nodes(std::span<const Pose> poses, std::span<const double> angles_rad,
                                   StokesTable &out, const LightTask &task) const {
  UMOV_EXPECTS(angles_rad.size() == poses.size() * joints_.size());
  return light(poses, angles_rad, out, task);
}

std::vector<double> LightModel::of_bands(const std::vector<double> &nodes) const {
  std::vector<double> out;
  for (std::size_t b = 0; b < scene_.bands.size() && !nodes.empty(); ++b)
    out.push_back(sum_band<double>(scene_.grid.terms()[b], [&](std::size_t node) {
                    return nodes[node];
                  }).value);
  return out;
}

bool LightModel::evaluate(std::span<const Pose> poses, StokesTable &out,
                          const LightTask &task) const {
  const std::vector<double> still(poses.size() * joints_.size(), 0);
  return evaluate(poses, still, out, task);
}

} // namespace umov
