#include <umov/shape/topology.h>

#include "shape/edges.h"
#include "shape/pairs.h"
#include "shape/weld.h"

#include <cmath>
#include <map>
#include <numeric>
#include <umov/core/quantity.h>
#include <umov/core/stop.h>

namespace umov {
namespace {

class Parts {
public:
  explicit Parts(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

private:
  std::vector<std::uint32_t> parent_;
};

struct Work {
  const Mesh &mesh;
  double size;
  std::vector<std::uint32_t> welded;
  std::vector<bool> skip; ///< degenerate
  std::vector<EdgeUse> edges;
};

void measure_faces(Work &work, MeshReport &out) {
  const Mesh &mesh = work.mesh;
  out.group_area_m2.assign(mesh.groups.size(), 0);
  out.group_triangles.assign(mesh.groups.size(), 0);
  out.lower = {INFINITY, INFINITY, INFINITY};
  out.upper = -1 * out.lower;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle &t = mesh.triangles[i];
    work.skip[i] = is_degenerate(mesh, t, work.welded);
    out.degenerate += work.skip[i] ? 1u : 0u;
    const Vec3<Body> doubled = area_vector_doubled(mesh, t);
    out.group_area_m2[t.front] += norm(doubled) / 2;
    out.group_triangles[t.front] += 1;
    out.volume_m3 += dot(mesh.positions[t.vertex[0]], doubled) / 6;
    for (const std::uint32_t v : t.vertex) {
      const Vec3<Body> p = mesh.positions[v];
      out.lower = {std::min(out.lower.x, p.x), std::min(out.lower.y, p.y),
                   std::min(out.lower.z, p.z)};
      out.upper = {std::max(out.upper.x, p.x), std::max(out.upper.y, p.y),
                   std::max(out.upper.z, p.z)};
    }
  }
  if (mesh.triangles.empty())
    out.lower = out.upper = {};
  for (const double area : out.group_area_m2)
    out.area_m2 += area;
}

void count_edges(const Work &work, MeshReport &out) {
  for_each_edge(work.edges, [&](const EdgeUse *first, const EdgeUse *last) {
    const auto uses = last - first;
    if (uses == 1)
      ++out.open_edges;
    else if (uses > 2)
      ++out.non_manifold_edges;
    else if (first[0].forward == first[1].forward)
      ++out.inconsistent_edges;
  });
}

void count_parts(const Work &work, MeshReport &out) {
  Parts parts(work.mesh.positions.size());
  for (std::size_t i = 0; i < work.mesh.triangles.size(); ++i) {
    if (work.skip[i])
      continue;
    const auto &v = work.mesh.triangles[i].vertex;
    parts.join(work.welded[v[0]], work.welded[v[1]]);
    parts.join(work.welded[v[1]], work.welded[v[2]]);
  }
  std::map<std::uint32_t, double> volumes;
  for (std::size_t i = 0; i < work.mesh.triangles.size(); ++i)
    if (const Triangle &t = work.mesh.triangles[i]; !work.skip[i])
      volumes[parts.find(work.welded[t.vertex[0]])] +=
          dot(work.mesh.positions[t.vertex[0]], area_vector_doubled(work.mesh, t)) / 6;
  std::map<std::uint32_t, bool> open;
  for_each_edge(work.edges, [&](const EdgeUse *first, const EdgeUse *last) {
    if (last - first != 2)
      open[parts.find(first->low)] = true;
  });
  out.parts = volumes.size();
  for (const auto &[part, volume] : volumes)
    if (volume < 0 && !open.contains(part))
      ++out.inward_parts;
}

/// Closed, connected, of the topology of a sphere, every edge convex and every vertex with less
/// than a full turn of face angles: then the surface bounds a convex body (van Heijenoort 1952).
bool is_convex(const Work &work, const MeshReport &found) {
  if (!found.is_closed || found.parts != 1 || found.inconsistent_edges > 0 ||
      !(found.volume_m3 > 0)) // repeated or opposite faces leave no such edges or no volume
    return false;
  const Mesh &mesh = work.mesh;
  std::vector<double> turn(mesh.positions.size(), 0);
  std::size_t faces = 0, vertices = 0, edges = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (work.skip[i])
      return false;
    ++faces;
    const auto &v = mesh.triangles[i].vertex;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3<Body> p = mesh.positions[v[k]];
      turn[work.welded[v[k]]] +=
          angle_between(mesh.positions[v[(k + 1) % 3]] - p, mesh.positions[v[(k + 2) % 3]] - p);
    }
  }
  for (const double angle : turn) {
    vertices += angle > 0 ? 1u : 0u;
    if (angle > 2 * pi + 1e-9)
      return false;
  }
  bool convex = true;
  for_each_edge(work.edges, [&](const EdgeUse *first, const EdgeUse *) {
    ++edges;
    const Vec3<Body> n = normalized(area_vector_doubled(mesh, mesh.triangles[first[0].triangle]));
    const Vec3<Body> on = mesh.positions[mesh.triangles[first[0].triangle].vertex[0]];
    for (const std::uint32_t v : mesh.triangles[first[1].triangle].vertex)
      convex = convex && dot(n, mesh.positions[v] - on) <= 1e-9 * work.size;
  });
  return convex && vertices + faces == edges + 2;
}

/// All corners in one plane: nothing can stand in front of anything.
bool is_flat_sheet(const Mesh &mesh) {
  if (mesh.triangles.empty())
    return false;
  const double size = mesh_size(mesh);
  const Triangle *largest = &mesh.triangles.front();
  for (const Triangle &t : mesh.triangles)
    if (norm(area_vector_doubled(mesh, t)) > norm(area_vector_doubled(mesh, *largest)))
      largest = &t;
  const Vec3<Body> n = normalized(area_vector_doubled(mesh, *largest));
  const Vec3<Body> on = mesh.positions[largest->vertex[0]];
  for (const Triangle &t : mesh.triangles)
    for (const std::uint32_t v : t.vertex)
      if (!(std::abs(dot(n, mesh.positions[v] - on)) <= 1e-9 * size))
        return false;
  return true;
}

} // namespace

MeshReport inspect(const Mesh &mesh, bool with_coincidence, const std::atomic<bool> *cancel) {
  MeshReport out;
  Work work{mesh,
            mesh_size(mesh),
            weld(mesh, weld_distance(mesh), cancel),
            std::vector<bool>(mesh.triangles.size(), false),
            {}};
  out.triangles = mesh.triangles.size();
  for (std::uint32_t i = 0; i < work.welded.size(); ++i)
    out.vertices += work.welded[i] == i ? 1u : 0u;
  measure_faces(work, out);
  leave_if_stopped(cancel);
  work.edges = sorted_edges(mesh, work.welded, work.skip, cancel);
  leave_if_stopped(cancel);
  count_edges(work, out);
  leave_if_stopped(cancel);
  count_parts(work, out);
  leave_if_stopped(cancel);
  if (with_coincidence) {
    const Coincidence found = find_coincidence(mesh, work.welded, work.skip, cancel);
    out.duplicate = found.duplicates;
    out.opposite_pairs = found.opposites;
  }
  out.is_closed = out.triangles > out.degenerate && out.open_edges + out.non_manifold_edges == 0;
  leave_if_stopped(cancel);
  out.is_convex = is_convex(work, out);
  return out;
}

bool is_proven_convex(const Mesh &mesh, const std::atomic<bool> *cancel) {
  const bool is_flat = is_flat_sheet(mesh);
  leave_if_stopped(cancel);
  return is_flat || inspect(mesh, false, cancel).is_convex;
}

double silhouette_upper_bound(const Mesh &mesh, Vec3<Body> direction) {
  double sum = 0;
  for (const Triangle &t : mesh.triangles)
    sum += std::abs(dot(area_vector_doubled(mesh, t), direction)) / 2;
  return inspect(mesh, false).is_closed ? sum / 2 : sum;
}

} // namespace umov
