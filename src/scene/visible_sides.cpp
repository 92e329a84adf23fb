#include <umov/scene/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <umov/core/stop.h>
#include <utility>

namespace umov {
namespace {

/// Vertex numbers in which coincident vertices (to `grain`) are one.
std::vector<std::size_t> weld(const std::vector<Vec3<Body>> &positions, double grain,
                              const std::atomic<bool> *cancel) {
  std::map<std::array<double, 3>, std::size_t> seen;
  std::vector<std::size_t> out(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    leave_if_stopped(cancel, i);
    const Vec3<Body> p = positions[i] / grain;
    out[i] = seen.try_emplace({std::round(p.x), std::round(p.y), std::round(p.z)}, i).first->second;
  }
  return out;
}

double size_of(const Mesh &mesh) {
  double extent = 0;
  for (const Vec3<Body> &p : mesh.positions)
    extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return extent;
}

class Parts {
public:
  explicit Parts(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }

private:
  std::vector<std::size_t> parent_;
};

/// One use of a welded edge by a triangle, which runs it upwards or downwards.
struct EdgeUse {
  std::uint32_t high, triangle;
  bool is_up;
};

/// All uses by their lower vertex, and in there by the higher one. No map: a million nodes take
/// half a second to be given back, which nobody can stop.
class Edges {
public:
  Edges(const Mesh &mesh, const std::vector<std::size_t> &vertex, const std::atomic<bool> *cancel)
      : first_(vertex.size() + 1, 0), uses_(3 * mesh.triangles.size()) {
    const auto for_each = [&](const auto &take) {
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        leave_if_stopped(cancel, t);
        for (std::size_t k = 0; k < 3; ++k)
          take(t, vertex[mesh.triangles[t].vertex[k]],
               vertex[mesh.triangles[t].vertex[(k + 1) % 3]]);
      }
    };
    for_each([&](std::size_t, std::size_t a, std::size_t b) { ++first_[std::min(a, b) + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for_each([&](std::size_t t, std::size_t a, std::size_t b) {
      uses_[next[std::min(a, b)]++] = {static_cast<std::uint32_t>(std::max(a, b)),
                                       static_cast<std::uint32_t>(t), a < b};
    });
    for (std::size_t v = 0; v + 1 < first_.size(); ++v) {
      leave_if_stopped(cancel, v);
      std::ranges::stable_sort(of(v), {}, &EdgeUse::high);
    }
  }
  /// Calls take(uses) for each edge.
  template <class Take> void for_each(const Take &take) const {
    for (std::size_t v = 0; v + 1 < first_.size(); ++v)
      for (std::size_t i = first_[v], end = i; i < first_[v + 1]; i = end) {
        while (end < first_[v + 1] && uses_[end].high == uses_[i].high)
          ++end;
        take(std::span(uses_).subspan(i, end - i));
      }
  }

private:
  [[nodiscard]] std::span<EdgeUse> of(std::size_t vertex) {
    return std::span(uses_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
  }
  std::vector<std::size_t> first_; ///< per lower vertex: into `uses_`
  std::vector<EdgeUse> uses_;
};

/// Two triangles meet there, wound alike.
bool is_joint(std::span<const EdgeUse> uses) {
  return uses.size() == 2 && uses[0].is_up != uses[1].is_up;
}

} // namespace

std::vector<VisibleSides> visible_sides(const Mesh &mesh, const std::atomic<bool> *cancel) {
  const std::size_t count = mesh.triangles.size();
  const double size = size_of(mesh);
  std::vector<VisibleSides> out(count);
  if (!(size > 0))
    return out;
  const auto vertex = weld(mesh.positions, 1e-6 * size, cancel);
  const Edges edges(mesh, vertex, cancel);
  Parts parts(count);
  edges.for_each([&](std::span<const EdgeUse> uses) {
    if (is_joint(uses))
      parts.join(uses[0].triangle, uses[1].triangle);
  });
  std::vector<char> is_closed(count, 1);
  std::vector<double> volume(count, 0);
  edges.for_each([&](std::span<const EdgeUse> uses) {
    for (const EdgeUse &use : uses)
      if (!is_joint(uses))
        is_closed[parts.root(use.triangle)] = 0;
  });
  for (std::size_t t = 0; t < count; ++t)
    volume[parts.root(t)] += dot(mesh.positions[mesh.triangles[t].vertex[0]],
                                 area_vector_doubled(mesh, mesh.triangles[t]));
  for (std::size_t t = 0; t < count; ++t) {
    const std::size_t part = parts.root(t);
    // A volume within rounding of nothing tells no inside.
    if (is_closed[part] && std::abs(volume[part]) > 1e-12 * size * size * size)
      (volume[part] > 0 ? out[t].back : out[t].front) = false;
  }
  return out;
}

} // namespace umov
