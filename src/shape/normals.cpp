#include <umov/shape/topology.h>

#include "shape/weld.h"

#include <cmath>

namespace umov {

Mesh with_vertex_normals(const Mesh &mesh, double crease_rad) {
  Mesh out = mesh;
  const auto welded = weld(mesh, weld_distance(mesh));
  std::vector<std::vector<std::uint32_t>> around(mesh.positions.size());
  std::vector<Vec3<Body>> area(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    area[i] = area_vector_doubled(mesh, mesh.triangles[i]);
    for (const std::uint32_t v : mesh.triangles[i].vertex)
      around[welded[v]].push_back(i);
  }
  const double limit = std::cos(crease_rad);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle &t = out.triangles[i];
    if (t.normal[0] != no_index || !(norm(area[i]) > 0))
      continue;
    const Vec3<Body> own = normalized(area[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3<Body> sum{};
      for (const std::uint32_t j : around[welded[t.vertex[k]]])
        if (mesh.triangles[j].front == t.front && norm(area[j]) > 0 &&
            dot(normalized(area[j]), own) >= limit - 1e-12)
          sum += area[j];
      t.normal[k] = static_cast<std::uint32_t>(out.normals.size());
      out.normals.push_back(norm(sum) > 0 ? normalized(sum) : own);
    }
  }
  return out;
}

} // namespace umov
