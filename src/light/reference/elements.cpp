#include "light/reference/elements.h"

#include <algorithm>
#include <cmath>
#include <umov/core/stop.h>

namespace umov {
namespace {

/// Normals that lean further than this from their face do not describe a curved patch over it.
constexpr double lift_cosine_min = 0.8;
constexpr int depth_max = 12; ///< halvings of one triangle, at most 4096 pieces

struct Corner {
  Vec3<Body> position, normal;
  std::array<double, 2> uv{};
};

double turn_between(const Corner &a, const Corner &b) { return norm(a.normal - b.normal); }

/// Half way along an edge, on the cubic curve through both ends that is perpendicular to their
/// normals (Vlachos et al. 2001, section 3.1): for a circle right to fourth order in the turn.
Corner middle(const Corner &a, const Corner &b, bool is_curved) {
  Corner m;
  m.position = 0.5 * (a.position + b.position);
  m.normal = normalized(a.normal + b.normal);
  m.uv = {0.5 * (a.uv[0] + b.uv[0]), 0.5 * (a.uv[1] + b.uv[1])};
  if (is_curved) {
    const Vec3<Body> edge = b.position - a.position;
    m.position += 0.125 * (dot(edge, b.normal) * b.normal - dot(edge, a.normal) * a.normal);
  }
  return m;
}

double flat_area(const Corner &a, const Corner &b, const Corner &c) {
  return 0.5 * norm(cross(b.position - a.position, c.position - a.position));
}

/// Area of the curved patch over three corners: one and four flat triangles, extrapolated
/// (Richardson), so that a coarse mesh of a curve misses area of fourth order in the turn only.
double patch_area(const std::array<Corner, 3> &c, bool is_curved) {
  const double one = flat_area(c[0], c[1], c[2]);
  if (!is_curved)
    return one;
  const Corner a = middle(c[1], c[2], true), b = middle(c[2], c[0], true),
               d = middle(c[0], c[1], true);
  const double four =
      flat_area(a, b, d) + flat_area(c[0], d, b) + flat_area(c[1], a, d) + flat_area(c[2], b, a);
  return four + (four - one) / 3;
}

class Splitter {
public:
  Splitter(Element prototype, double turn_max, bool is_curved, std::vector<Element> &out)
      : prototype_(prototype), turn_max_(turn_max), is_curved_(is_curved), out_(out) {}

  /// Halves the edge along which the normal turns most until it turns little enough: a cylinder is
  /// cut across its curvature only.
  void split(const std::array<Corner, 3> &c, int depth) {
    std::size_t edge = 0;
    double most = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double turn = turn_between(c[k], c[(k + 1) % 3]);
      if (turn > most * (1 + 1e-9)) {
        most = turn;
        edge = k;
      }
    }
    if (most <= turn_max_ || depth == depth_max) {
      add(c, most);
      return;
    }
    const Corner m = middle(c[edge], c[(edge + 1) % 3], is_curved_);
    const Corner &opposite = c[(edge + 2) % 3];
    split({c[edge], m, opposite}, depth + 1);
    split({m, c[(edge + 1) % 3], opposite}, depth + 1);
  }

private:
  void add(const std::array<Corner, 3> &c, double turn) {
    Element e = prototype_;
    e.turn_rad = static_cast<float>(turn);
    e.turn_max_rad = static_cast<float>(turn_max_);
    e.area_m2 = patch_area(c, is_curved_);
    for (std::size_t k = 0; k < 3; ++k) {
      e.normal[k] = c[k].normal;
      e.corner[k] = c[k].uv;
    }
    out_.push_back(e);
  }

  Element prototype_;
  double turn_max_;
  bool is_curved_;
  std::vector<Element> &out_;
};

SideSlots slots_of(const Triangle &t, VisibleSides sides) {
  SideSlots out;
  if (sides.front)
    out.front = slot_of(t.front, false);
  // Two opposite faces merged into one: the back shows the front material of the other face.
  if (sides.back)
    out.back = t.back == t.front ? slot_of(t.front, true) : slot_of(t.back, false);
  return out;
}

double turn_limit(const Scene &scene, SideSlots slots) {
  double width = 1;
  for (const std::uint32_t slot : {slots.front, slots.back})
    if (slot != no_index)
      width = std::min(width, surface_of_slot(scene, slot).width());
  return std::clamp(element_turn_in_lobes * width, element_turn_min_rad, element_turn_max_rad);
}

/// Unit normals at the corners; the winding is right where a vertex normal contradicts it.
std::array<Vec3<Body>, 3> corner_normals(const Mesh &mesh, const Triangle &t, Vec3<Body> face) {
  std::array<Vec3<Body>, 3> out{face, face, face};
  Vec3<Body> sum{};
  for (std::size_t k = 0; k < 3; ++k)
    if (t.normal[k] != no_index && dot(mesh.normals[t.normal[k]], mesh.normals[t.normal[k]]) > 0) {
      out[k] = normalized(mesh.normals[t.normal[k]]);
      sum += out[k];
    }
  if (dot(sum, face) < 0)
    for (std::size_t k = 0; k < 3; ++k)
      out[k] = t.normal[k] != no_index ? -out[k] : out[k];
  return out;
}

double diagonal(const Mesh &mesh) {
  if (mesh.positions.empty())
    return 0;
  Vec3<Body> low = mesh.positions[0], high = low;
  for (const Vec3<Body> &p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return norm(high - low);
}

} // namespace

Elements make_elements(const Scene &scene, const std::vector<VisibleSides> &sides,
                       const std::atomic<bool> *cancel) {
  const Mesh &mesh = scene.mesh;
  Elements out;
  out.size_m = diagonal(mesh);
  out.slots.resize(mesh.triangles.size());
  out.normal.resize(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    leave_if_stopped(cancel, i);
    const Triangle &t = mesh.triangles[i];
    out.slots[i] = slots_of(t, sides[i]);
    const Vec3<Body> doubled = area_vector_doubled(mesh, t);
    const double length = norm(doubled);
    if (!(length > 0))
      continue; // a face without area has no light and no normal
    const Vec3<Body> face = doubled / length;
    out.normal[i] = face;
    std::array<Vec3<Body>, 3> normal{face, face, face};
    if (scene.normals == NormalMode::Smooth)
      normal = corner_normals(mesh, t, face);
    Element e{
        normal, {{{0, 0}, {1, 0}, {0, 1}}}, 0.5 * length, static_cast<std::uint32_t>(i), true};
    constexpr double agree = 1e-9; // [rad]
    e.is_flat = norm(normal[0] - normal[1]) < agree && norm(normal[0] - normal[2]) < agree;
    if (e.is_flat) {
      out.list.push_back(e);
      continue;
    }
    std::array<Corner, 3> corners;
    bool is_curved = true;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = {mesh.positions[t.vertex[k]], normal[k], e.corner[k]};
      is_curved = is_curved && dot(normal[k], face) > lift_cosine_min;
    }
    Splitter(e, turn_limit(scene, out.slots[i]), is_curved, out.list).split(corners, 0);
  }
  return out;
}

} // namespace umov
