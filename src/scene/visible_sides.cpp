#include <umov/scene/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
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

/// Triangles along one welded edge, those that run it upwards and downwards.
struct EdgeUse {
  std::vector<std::size_t> up, down;
};

} // namespace

std::vector<VisibleSides> visible_sides(const Mesh &mesh, const std::atomic<bool> *cancel) {
  const std::size_t count = mesh.triangles.size();
  const double size = size_of(mesh);
  std::vector<VisibleSides> out(count);
  if (!(size > 0))
    return out;
  const auto vertex = weld(mesh.positions, 1e-6 * size, cancel);
  std::map<std::pair<std::size_t, std::size_t>, EdgeUse> edges;
  for (std::size_t t = 0; t < count; ++t) {
    leave_if_stopped(cancel, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = vertex[mesh.triangles[t].vertex[k]];
      const std::size_t b = vertex[mesh.triangles[t].vertex[(k + 1) % 3]];
      EdgeUse &use = edges[std::minmax(a, b)];
      (a < b ? use.up : use.down).push_back(t);
    }
  }
  leave_if_stopped(cancel);
  Parts parts(count);
  for (const auto &[edge, use] : edges)
    if (use.up.size() == 1 && use.down.size() == 1)
      parts.join(use.up[0], use.down[0]);
  std::vector<char> is_closed(count, 1);
  std::vector<double> volume(count, 0);
  for (const auto &[edge, use] : edges)
    if (use.up.size() != 1 || use.down.size() != 1)
      for (const auto &list : {use.up, use.down})
        for (const std::size_t t : list)
          is_closed[parts.root(t)] = 0;
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
