#pragma once
// Private: edges of a welded mesh with the faces on both sides.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <tuple>
#include <umov/core/stop.h>
#include <umov/shape/mesh.h>
#include <vector>

namespace umov {

/// One use of an edge by a triangle; `forward`: from the smaller to the larger vertex.
struct EdgeUse {
  std::uint32_t low, high, triangle;
  bool forward;
};

/// All uses, sorted by edge. `skip[i]` leaves a triangle out. Throws Failure (Interrupted) once
/// `cancel`, which may be null, became true.
inline std::vector<EdgeUse> sorted_edges(const Mesh &mesh, const std::vector<std::uint32_t> &welded,
                                         const std::vector<bool> &skip,
                                         const std::atomic<bool> *cancel) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    leave_if_stopped(cancel, i);
    if (skip[i])
      continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = welded[mesh.triangles[i].vertex[k]];
      const std::uint32_t b = welded[mesh.triangles[i].vertex[(k + 1) % 3]];
      uses.push_back({std::min(a, b), std::max(a, b), i, a < b});
    }
  }
  std::size_t compared = 0; // millions of edges take half a second
  std::sort(uses.begin(), uses.end(), [&](const EdgeUse &a, const EdgeUse &b) {
    leave_if_stopped(cancel, compared++);
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return uses;
}

/// Calls take(first, last) for the uses of each edge.
template <class Take> void for_each_edge(const std::vector<EdgeUse> &uses, Take take) {
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t j = i + 1;
    while (j < uses.size() && uses[j].low == uses[i].low && uses[j].high == uses[i].high)
      ++j;
    take(&uses[i], &uses[i] + (j - i));
    i = j;
  }
}

} // namespace umov
