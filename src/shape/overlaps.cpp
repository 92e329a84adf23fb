#include "shape/pairs.h"

#include "shape/edges.h"
#include "shape/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>
#include <umov/core/parallel.h>
#include <umov/core/stop.h>

namespace umov {
namespace {

struct Bounds {
  Vec3<Body> low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};

  void add(Vec3<Body> p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  void add(const Bounds &b) {
    add(b.low);
    add(b.high);
  }
  [[nodiscard]] bool touches(const Bounds &b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y &&
           low.z <= b.high.z && b.low.z <= high.z;
  }
};

/// The lowest 21 bits with two zeros between each and the next.
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}

/// Boxes in a binary tree over their order along a space-filling curve (Morton 1966): node k of a
/// level holds the nodes 2k and 2k + 1 of the one below.
class BoxTree {
public:
  BoxTree(const std::vector<Bounds> &boxes, const std::vector<std::uint32_t> &items) {
    Bounds all;
    for (const std::uint32_t i : items)
      all.add(boxes[i]);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    for (const std::uint32_t i : items) {
      const auto cell = [](double low, double high, double from, double to) {
        const double part = to > from ? ((low + high) / 2 - from) / (to - from) : 0;
        return spread(static_cast<std::uint64_t>(std::clamp(part, 0.0, 1.0) * 0x1fffff));
      };
      const Bounds &b = boxes[i];
      order.emplace_back(cell(b.low.x, b.high.x, all.low.x, all.high.x) |
                             cell(b.low.y, b.high.y, all.low.y, all.high.y) << 1 |
                             cell(b.low.z, b.high.z, all.low.z, all.high.z) << 2,
                         i);
    }
    std::sort(order.begin(), order.end());
    levels_.emplace_back();
    for (const auto &[key, i] : order) {
      items_.push_back(i);
      levels_[0].push_back(boxes[i]);
    }
    while (levels_.back().size() > 1) {
      std::vector<Bounds> next((levels_.back().size() + 1) / 2);
      for (std::size_t k = 0; k < levels_.back().size(); ++k)
        next[k / 2].add(levels_.back()[k]);
      levels_.push_back(std::move(next));
    }
  }

  /// Items in the order of the curve.
  [[nodiscard]] const std::vector<std::uint32_t> &items() const { return items_; }

  /// Calls take(item) for every item behind the one at `place` whose box touches that one's, until
  /// it says false.
  template <class Take> void visit_behind(std::size_t place, Take take) const {
    const Bounds box = levels_[0][place];
    std::array<std::pair<std::size_t, std::size_t>, 80> stack;
    std::size_t depth = 0;
    stack[depth++] = {levels_.size() - 1, 0};
    while (depth > 0) {
      const auto [level, k] = stack[--depth];
      if ((k + 1) << level <= place + 1 || !levels_[level][k].touches(box))
        continue;
      if (level == 0) {
        if (!take(items_[k]))
          return;
        continue;
      }
      for (std::size_t child = 2 * k; child < 2 * k + 2; ++child)
        if (child < levels_[level - 1].size())
          stack[depth++] = {level - 1, child};
    }
  }

private:
  std::vector<std::uint32_t> items_;
  std::vector<std::vector<Bounds>> levels_;
};

struct Flat {
  double x, y;
};

/// Area that two triangles in one plane have in common; `b` counter-clockwise (Sutherland & Hodgman
/// 1974).
double common_area(const std::array<Flat, 3> &a, const std::array<Flat, 3> &b) {
  std::array<Flat, 8> now{a[0], a[1], a[2]}, next{};
  std::size_t count = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    const Flat p = b[k], q = b[(k + 1) % 3];
    const auto side = [&](Flat v) { return (q.x - p.x) * (v.y - p.y) - (q.y - p.y) * (v.x - p.x); };
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Flat from = now[i], to = now[(i + 1) % count];
      const double s = side(from), t = side(to);
      if (s >= 0)
        next[kept++] = from;
      if ((s > 0 && t < 0) || (s < 0 && t > 0))
        next[kept++] = {from.x + (to.x - from.x) * s / (s - t),
                        from.y + (to.y - from.y) * s / (s - t)};
    }
    now = next;
    count = kept;
  }
  double doubled = 0;
  for (std::size_t i = 1; i + 1 < count; ++i)
    doubled += (now[i].x - now[0].x) * (now[i + 1].y - now[0].y) -
               (now[i].y - now[0].y) * (now[i + 1].x - now[0].x);
  return std::abs(doubled) / 2;
}

/// Number of the solid part that a triangle bounds, or no_index: triangles joined by edges that
/// exactly two of them share in opposite directions, without an open edge, round some volume.
std::vector<std::uint32_t> solid_parts(const Mesh &mesh, const std::vector<std::uint32_t> &welded,
                                       const std::vector<bool> &skip,
                                       const std::atomic<bool> *cancel) {
  std::vector<std::uint32_t> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), std::uint32_t{0});
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto is_joint = [](const EdgeUse *first, const EdgeUse *last) {
    return last - first == 2 && first[0].forward != first[1].forward;
  };
  const auto edges = sorted_edges(mesh, welded, skip, cancel);
  for_each_edge(edges, [&](const EdgeUse *first, const EdgeUse *last) {
    if (is_joint(first, last))
      parent[root(first[0].triangle)] = root(first[1].triangle);
  });
  std::vector<bool> is_open(parent.size(), false);
  for_each_edge(edges, [&](const EdgeUse *first, const EdgeUse *last) {
    if (!is_joint(first, last))
      for (const EdgeUse *use = first; use != last; ++use)
        is_open[root(use->triangle)] = true;
  });
  std::vector<double> volume(parent.size(), 0);
  for (std::uint32_t i = 0; i < parent.size(); ++i)
    volume[root(i)] += dot(mesh.positions[mesh.triangles[i].vertex[0]],
                           area_vector_doubled(mesh, mesh.triangles[i])) /
                       6;
  const double least = 1e-12 * std::pow(mesh_size(mesh), 3);
  std::vector<std::uint32_t> out(parent.size(), no_index);
  for (std::uint32_t i = 0; i < parent.size(); ++i)
    if (const std::uint32_t part = root(i); !skip[i] && !is_open[part] && volume[part] > least)
      out[i] = part;
  return out;
}

class Search {
public:
  Search(const Mesh &mesh, const std::vector<std::uint32_t> &welded, const std::vector<bool> &skip)
      : mesh_(mesh), welded_(welded), near_(2 * weld_distance(mesh)),
        boxes_(mesh.triangles.size()) {
    const Vec3<Body> margin{near_, near_, near_};
    for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
      if (skip[i])
        continue;
      // Polygons that are not quite flat lie apart by more, but share corners: their boxes meet.
      for (const Vec3<Body> &p : corners(i))
        boxes_[i].add(p);
      boxes_[i].low -= margin;
      boxes_[i].high += margin;
      items_.push_back(i);
    }
  }

  [[nodiscard]] Overlaps run(const std::atomic<bool> *cancel) const {
    const BoxTree tree(boxes_, items_);
    // Some seconds of work in the worst of crowds; a mesh that is not one never gets near it.
    const std::size_t most = std::max<std::size_t>(2000, 4'000'000'000 / (items_.size() + 1));
    std::vector<std::vector<Overlap>> found(items_.size());
    std::vector<unsigned char> is_cut(items_.size(), 0);
    parallel_for(items_.size(), 0, [&](std::size_t k) {
      leave_if_stopped(cancel);
      const std::uint32_t i = tree.items()[k];
      std::size_t seen = 0;
      tree.visit_behind(k, [&](std::uint32_t j) {
        if (const auto one = overlap(std::min(i, j), std::max(i, j)))
          found[k].push_back(*one);
        is_cut[k] = ++seen >= most ? 1 : 0;
        return is_cut[k] == 0;
      });
    });
    Overlaps out;
    for (std::size_t k = 0; k < found.size(); ++k) {
      out.pairs.insert(out.pairs.end(), found[k].begin(), found[k].end());
      out.not_searched += is_cut[k];
    }
    std::sort(out.pairs.begin(), out.pairs.end(), [](const Overlap &a, const Overlap &b) {
      return std::tie(a.first, a.second) < std::tie(b.first, b.second);
    });
    return out;
  }

private:
  using Corners = std::array<Vec3<Body>, 3>;

  [[nodiscard]] Corners corners(std::uint32_t i) const {
    const auto &v = mesh_.triangles[i].vertex;
    return {mesh_.positions[welded_[v[0]]], mesh_.positions[welded_[v[1]]],
            mesh_.positions[welded_[v[2]]]};
  }

  [[nodiscard]] bool share_corner(std::uint32_t i, std::uint32_t j) const {
    for (const std::uint32_t v : mesh_.triangles[i].vertex)
      for (const std::uint32_t w : mesh_.triangles[j].vertex)
        if (welded_[v] == welded_[w])
          return true;
    return false;
  }

  [[nodiscard]] std::optional<Overlap> overlap(std::uint32_t i, std::uint32_t j) const {
    Corners large = corners(i), small = corners(j);
    const auto doubled = [](const Corners &c) { return cross(c[1] - c[0], c[2] - c[0]); };
    Vec3<Body> n = doubled(large), m = doubled(small);
    const double cosine = dot(n, m), n2 = dot(n, n), m2 = dot(m, m);
    // 8 deg: what the welding distance may turn the smallest of faces by.
    if (!(cosine * cosine >= 0.98 * n2 * m2) || !(n2 > 0) || !(m2 > 0))
      return {};
    if (m2 > n2) {
      std::swap(large, small);
      std::swap(n, m);
    }
    n = normalized(n);
    Overlap out{i, j, 0, 0, cosine < 0};
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      out.apart_m = std::max(out.apart_m, std::abs(dot(n, small[k] - large[0])));
      longest = std::max(longest, norm(small[(k + 1) % 3] - small[k]));
    }
    const bool is_flat = out.apart_m <= near_;
    if (!is_flat && (out.apart_m > 1e-3 * longest || !share_corner(i, j)))
      return {};
    const Vec3<Body> x = any_perpendicular(n), y = cross(n, x);
    std::array<Flat, 3> a{}, b{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3<Body> p = small[k] - large[0], q = large[k] - large[0];
      a[k] = {dot(p, x), dot(p, y)};
      b[k] = {dot(q, x), dot(q, y)};
    }
    out.area_m2 = common_area(a, b);
    // Neighbours overlap by a strip as wide as corners may be apart.
    if (out.area_m2 <=
        3 * near_ * longest + (is_flat ? 1e-9 : 1e-3) * std::sqrt(std::min(n2, m2)) / 2)
      return {};
    return out;
  }

  const Mesh &mesh_;
  const std::vector<std::uint32_t> &welded_;
  double near_;
  std::vector<std::uint32_t> items_;
  std::vector<Bounds> boxes_;
};

} // namespace

Overlaps find_overlaps(const Mesh &mesh, const std::vector<std::uint32_t> &welded,
                       const std::vector<bool> &skip, const std::atomic<bool> *cancel) {
  Overlaps out = Search(mesh, welded, skip).run(cancel);
  if (std::none_of(out.pairs.begin(), out.pairs.end(),
                   [](const Overlap &o) { return o.is_opposite; }))
    return out;
  const auto solid = solid_parts(mesh, welded, skip, cancel);
  std::erase_if(out.pairs, [&](const Overlap &o) {
    return o.is_opposite && solid[o.first] != no_index && solid[o.second] != no_index &&
           solid[o.first] != solid[o.second];
  });
  return out;
}

} // namespace umov
