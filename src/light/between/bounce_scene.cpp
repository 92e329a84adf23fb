#include "light/between/bounce_scene.h"

#include "light/between/mirror_parts.h"
#include "light/reference/elements.h"

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
  mirrors_ = std::make_unique<const MirrorParts>(*this);
}

BounceScene::~BounceScene() = default;

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

Vertex BounceScene::vertex_on(std::uint32_t t, double b1, double b2, Vec3<Body> towards) const {
  const Mesh &mesh = scene_.mesh;
  const Triangle &triangle = mesh.triangles[t];
  const double side = dot(normal_[t], towards) < 0 ? -1 : 1;
  const double weight[3] = {1 - b1 - b2, b1, b2};
  Vertex out;
  out.face = side * normal_[t];
  out.normal = out.face;
  Vec3<Body> bent{};
  bool is_smooth = scene_.normals == NormalMode::Smooth;
  for (std::size_t k = 0; k < 3; ++k) {
    out.point += weight[k] * mesh.positions[triangle.vertex[k]];
    is_smooth = is_smooth && triangle.normal[k] != no_index;
    if (is_smooth)
      bent += weight[k] * mesh.normals[triangle.normal[k]];
  }
  if (is_smooth && norm(bent) > 0)
    out.normal = normalized(dot(bent, out.face) < 0 ? -bent : bent);
  out.point += out.face * (ray_offset * size_m_);
  out.surface = &surface_of_side(scene_, triangle, side > 0);
  out.triangle = t;
  out.is_front = side > 0;
  const bool is_own_back = side <= 0 && triangle.back == triangle.front;
  out.slot = is_own_back ? slot_of(triangle.back, true)
                         : slot_of(side > 0 ? triangle.front : triangle.back, false);
  out.sampler = is_own_back ? &back_sampler_[triangle.back]
                            : &front_sampler_[side > 0 ? triangle.front : triangle.back];
  out.field = direction_field(mesh, *out.surface, t);
  return out;
}

bool BounceScene::next(const Occluder &occluder, const Vertex &from, Vec3<Body> direction,
                       Vertex &to, double &distance) const {
  if (!(dot(from.face, direction) > 0))
    return false;
  const Occluder::Hit hit = occluder.nearest(from.point, direction);
  if (hit.triangle == no_index)
    return false;
  to = vertex_on(hit.triangle, static_cast<double>(hit.u), static_cast<double>(hit.v), -direction);
  distance = hit.distance_m;
  return distance > 0;
}

} // namespace umov
