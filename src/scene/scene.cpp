#include <umov/scene/scene.h>

#include "scene/compiled_materials.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

/// Vertex normals far from their face come from a broken export and darken it without a word.
void warn_of_odd_normals(const Mesh &mesh, const std::string &file, Diagnostics &diagnostics) {
  constexpr double far = 0.5; // cosine: 60 deg, far beyond any crease that one would smooth over
  std::size_t count = 0;
  for (const Triangle &t : mesh.triangles) {
    const Vec3<Body> own = normalized(area_vector_doubled(mesh, t));
    bool is_odd = false;
    for (const std::uint32_t n : t.normal)
      is_odd = is_odd || (n != no_index && dot(mesh.normals[n], own) < far);
    count += is_odd ? 1u : 0u;
  }
  if (count > 0)
    diagnostics.warn(fmt::format("{} vertex normals more than 60 deg off the face; their light is "
                                 "doubtful. Mend the normals or take normals = \"flat\".",
                                 counted(count, "triangle has", "triangles have")),
                     {file});
}

} // namespace

Result<Scene> make_scene(const Mesh &mesh, NormalMode normals, const std::vector<Band> &bands,
                         const std::vector<Material> &front, const std::vector<Material> &back,
                         Diagnostics &diagnostics, double crease_rad, const std::string &file,
                         const std::atomic<bool> *cancel) {
  if (front.size() != mesh.groups.size() || back.size() != mesh.groups.size())
    return fail(ErrorCode::BadInput,
                fmt::format("{} front and {} back materials for a mesh with {} groups; give one of "
                            "each per group",
                            front.size(), back.size(), mesh.groups.size()));
  if (bands.empty())
    return fail(ErrorCode::BadInput, "the scene has no band; name at least one, such as nm:550");
  UMOV_ASSIGN(cleaned, clean_mesh(mesh, diagnostics, file, cancel));
  Scene scene;
  scene.mesh = std::move(cleaned);
  scene.normals = normals;
  scene.bands = bands;
  if (normals == NormalMode::Smooth) { // where the mesh has none
    scene.mesh = with_vertex_normals(scene.mesh, crease_rad, cancel);
    warn_of_odd_normals(scene.mesh, file, diagnostics);
  }
  UMOV_ASSIGN(materials, CompiledMaterials::make(bands, front, back));
  scene.grid = materials.grid();
  for (std::size_t g = 0; g < front.size(); ++g) {
    scene.front.push_back(materials.of(front[g]));
    scene.back.push_back(materials.of(back[g]));
    for (const Surface *surface : {&scene.front.back(), &scene.back.back()})
      if (surface->is_anisotropic() && !surface->material().direction &&
          scene.mesh.tangents.empty())
        return fail(
            ErrorCode::BadInput,
            fmt::format("material \"{}\" needs a direction field: say direction = \"+X\" (a "
                        "body axis) or give the mesh texture coordinates",
                        surface->material().name));
  }
  return scene;
}

Result<Scene>
with_materials(const Scene &scene,
               const std::function<Material(const Material &, const std::string &group)> &change) {
  const auto changed = [&](const std::vector<Surface> &side) {
    std::vector<Material> out;
    for (std::size_t g = 0; g < side.size(); ++g)
      out.push_back(change(side[g].material(), scene.mesh.groups[g]));
    return out;
  };
  const std::vector<Material> front = changed(scene.front), back = changed(scene.back);
  UMOV_ASSIGN(materials, CompiledMaterials::make(scene.bands, front, back));
  Scene out{scene.mesh, scene.normals, scene.bands, materials.grid(), {}, {}};
  for (std::size_t g = 0; g < front.size(); ++g) {
    out.front.push_back(materials.of(front[g]));
    out.back.push_back(materials.of(back[g]));
  }
  return out;
}

Vec3<Body> direction_field(const Mesh &mesh, const Surface &surface, std::size_t triangle) {
  if (!surface.is_anisotropic())
    return {};
  if (surface.material().direction)
    return *surface.material().direction;
  return triangle < mesh.tangents.size() ? mesh.tangents[triangle] : Vec3<Body>{};
}

SurfaceDirections directions_on(Vec3<Body> normal, Vec3<Body> field, Vec3<Body> to_source,
                                Vec3<Body> to_observer, double cos_phase, double disk_rad) {
  const Vec3<Body> &n = normal;
  // Some frame without roots or branches (Duff et al. 2017): most surfaces do not ask which.
  const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  Vec3<Body> x{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, y{b, sign + n.y * n.y * a, -n.y};
  if (!(field == Vec3<Body>{})) {
    const Vec3<Body> along = field - dot(field, n) * n;
    if (const double length = norm(along); length > 1e-9) {
      x = along / length;
      y = cross(n, x);
    }
  }
  return {{dot(to_source, x), dot(to_source, y), dot(to_source, normal)},
          {dot(to_observer, x), dot(to_observer, y), dot(to_observer, normal)},
          cos_phase,
          disk_rad};
}

} // namespace umov
