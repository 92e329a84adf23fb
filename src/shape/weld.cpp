#include "shape/weld.h"

#include <algorithm>
#include <cmath>
#include <umov/core/stop.h>
#include <unordered_map>

namespace umov {
namespace {

struct Cell {
  std::int64_t x, y, z;
  friend bool operator==(const Cell &, const Cell &) = default;
};

struct CellHash {
  std::size_t operator()(const Cell &c) const {
    // Odd multipliers spread neighbouring cells (Teschner et al. 2003).
    const auto u = [](std::int64_t v) { return static_cast<std::uint64_t>(v); };
    return static_cast<std::size_t>(u(c.x) * 73856093u ^ u(c.y) * 19349663u ^ u(c.z) * 83492791u);
  }
};

} // namespace

double mesh_size(const Mesh &mesh) {
  Vec3<Body> low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (const Triangle &t : mesh.triangles)
    for (const std::uint32_t v : t.vertex) {
      const Vec3<Body> p = mesh.positions[v];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  return mesh.triangles.empty() ? 0 : norm(high - low);
}

double weld_distance(const Mesh &mesh) { return 1e-6 * mesh_size(mesh); }

std::vector<std::uint32_t> weld(const Mesh &mesh, double distance,
                                const std::atomic<bool> *cancel) {
  std::vector<std::uint32_t> out(mesh.positions.size());
  // Vertices of a cell follow each other by `next`: a list for each takes as long to be given back
  // as to be made, which nobody can stop.
  struct Ends {
    std::uint32_t first = no_index, last = no_index;
  };
  std::unordered_map<Cell, Ends, CellHash> cells;
  std::vector<std::uint32_t> next(mesh.positions.size(), no_index);
  const double width = std::max(distance, 1e-300);
  // Far cells share one number: vertices that no face uses may lie anywhere, and the distance test
  // decides in the end.
  const auto index = [&](double v) {
    return static_cast<std::int64_t>(std::clamp(std::floor(v / width), -0x1p50, 0x1p50));
  };
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
    leave_if_stopped(cancel, i);
    const Vec3<Body> p = mesh.positions[i];
    const Cell home{index(p.x), index(p.y), index(p.z)};
    out[i] = i;
    for (std::int64_t k = 0; k < 27 && out[i] == i; ++k) {
      const auto found =
          cells.find({home.x + k % 3 - 1, home.y + k / 3 % 3 - 1, home.z + k / 9 - 1});
      if (found == cells.end())
        continue;
      for (std::uint32_t other = found->second.first; other != no_index; other = next[other])
        if (norm(mesh.positions[other] - p) <= distance) {
          out[i] = other;
          break;
        }
    }
    if (out[i] != i)
      continue;
    Ends &ends = cells[home];
    (ends.first == no_index ? ends.first : next[ends.last]) = i;
    ends.last = i;
  }
  return out;
}

bool is_degenerate(const Mesh &mesh, const Triangle &t, const std::vector<std::uint32_t> &welded) {
  const std::uint32_t a = welded[t.vertex[0]], b = welded[t.vertex[1]], c = welded[t.vertex[2]];
  if (a == b || b == c || c == a)
    return true;
  const Vec3<Body> p = mesh.positions[t.vertex[0]], q = mesh.positions[t.vertex[1]],
                   r = mesh.positions[t.vertex[2]];
  const double longest = std::max({norm(q - p), norm(r - q), norm(p - r)});
  // A height of 1e-12 of the longest side is rounding, not a shape.
  return norm(cross(q - p, r - p)) <= 1e-12 * longest * longest;
}

} // namespace umov
