#include "light/between/bounce_scene.h"

#include <algorithm>
#include <cmath>

namespace umov {
BounceScene::BounceScene(const Scene &scene, const std::vector<VisibleSides> &sides)
    : scene_(scene), sides_(sides) {
  Vec3<Body> low{INFINITY, INFINITY, INFINITY}, high = -1 * low;
  for (const Triangle &t : scene.mesh.triangles) {
    const Vec3<Body> doubled = area_vector_doubled(scene.mesh, t);
    const double length = norm(doubled);
    normal_.push_back(length > 0 ? doubled / length : Vec3<Body>{});
    area_m2_.push_back(length / 2);
    for (const std::uint32_t v : t.vertex) {
      const Vec3<Body> p = scene.mesh.positions[v];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  size_m_ = norm(high - low);
  for (std::size_t g = 0; g < scene.front.size(); ++g) {
    front_sampler_.emplace_back(scene.front[g]);
    back_sampler_.emplace_back(scene.back[g]);
  }
  group_triangles();
}

void BounceScene::group_triangles() {
  double whole = 0;
  for (const double area : area_m2_)
    whole += area;
  constexpr double groups_wanted = 400;
  constexpr std::size_t groups_max = 2000;
  // Crumpled or mixed meshes turn at every triangle: there, by area alone.
  for (const bool is_by_normal : {true, false}) {
    groups_ = {};
    const Triangle *last = nullptr;
    double area = 0;
    for (std::size_t t = 0; t < area_m2_.size(); ++t) {
      const Triangle &triangle = scene_.mesh.triangles[t];
      const bool is_other =
          last == nullptr || triangle.front != last->front || dot(normal_[t], normal_[t - 1]) < 0.8;
      if (last == nullptr || (is_by_normal && is_other) || area > whole / groups_wanted) {
        ++groups_.count;
        area = 0;
      }
      area += area_m2_[t];
      groups_.of.push_back(static_cast<std::uint32_t>(groups_.count - 1));
      last = &triangle;
    }
    if (groups_.count <= groups_max)
      return;
  }
}

} // namespace umov
