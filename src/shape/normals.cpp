#include <umov/shape/topology.h>

#include "shape/weld.h"

#include <cmath>
#include <umov/core/stop.h>

namespace umov {

namespace {

/// Normal of a face weighted for the vertex `corner` by 1/(a^2 b^2), a and b the edges that meet
/// there: exact where the vertices lie on a sphere, whatever the shapes of the faces (Max 1999).
Vec3<Body> weighted_normal(const Mesh &mesh, const Triangle &t, std::size_t corner) {
  const Vec3<Body> p = mesh.positions[t.vertex[corner]];
  const Vec3<Body> a = mesh.positions[t.vertex[(corner + 1) % 3]] - p;
  const Vec3<Body> b = mesh.positions[t.vertex[(corner + 2) % 3]] - p;
  return cross(a, b) / (dot(a, a) * dot(b, b));
}

} // namespace

Mesh with_vertex_normals(const Mesh &mesh, double crease_rad, const std::atomic<bool> *cancel) {
  Mesh out = mesh;
  const auto welded = weld(mesh, weld_distance(mesh), cancel);
  std::vector<std::vector<std::uint32_t>> around(mesh.positions.size());
  std::vector<Vec3<Body>> area(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    area[i] = area_vector_doubled(mesh, mesh.triangles[i]);
    for (const std::uint32_t v : mesh.triangles[i].vertex)
      around[welded[v]].push_back(i);
  }
  const double limit = std::cos(crease_rad);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    leave_if_stopped(cancel, i);
    Triangle &t = out.triangles[i];
    if (t.normal[0] != no_index || !(norm(area[i]) > 0))
      continue;
    const Vec3<Body> own = normalized(area[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3<Body> sum{};
      for (const std::uint32_t j : around[welded[t.vertex[k]]])
        if (mesh.triangles[j].front == t.front && norm(area[j]) > 0 &&
            dot(normalized(area[j]), own) >= limit - 1e-12)
          for (std::size_t c = 0; c < 3; ++c)
            if (welded[mesh.triangles[j].vertex[c]] == welded[t.vertex[k]])
              sum += weighted_normal(mesh, mesh.triangles[j], c);
      t.normal[k] = static_cast<std::uint32_t>(out.normals.size());
      out.normals.push_back(norm(sum) > 0 ? normalized(sum) : own);
    }
  }
  return out;
}

} // namespace umov
