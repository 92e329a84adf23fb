#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>
#include <umov/optics/band_grid.h>
#include <umov/shape/mesh.h>
#include <umov/surface/surface.h>
#include <vector>

namespace umov {

/// Normals of the triangles, or of the vertices in between.
enum class NormalMode { Flat, Smooth };

/// One object ready to be lit: a cleaned mesh, the bands and a compiled surface for each mesh
/// group, at the wavelengths that the bands are summed from.
struct Scene {
  Mesh mesh;
  NormalMode normals = NormalMode::Flat;
  std::vector<Band> bands;    ///< that are asked for
  BandGrid grid;              ///< of them: light is computed at its nodes
  std::vector<Surface> front; ///< per mesh group: seen when the group is the side faced
  std::vector<Surface> back;  ///< per mesh group: where the back of that group's faces is seen
};

/// Crease angle [rad] of the vertex normals that `make_scene` makes for a mesh without any: faces
/// that meet at a larger angle keep their edge (a tube of 12 sides is still round).
inline constexpr double default_crease_rad = 35 * 3.14159265358979323846 / 180;

/// Cleans the mesh, makes vertex normals for `Smooth` where it has none and compiles each distinct
/// material once. `front` and `back` name the material of each group of `mesh.groups`.
/// `file` is what messages about the mesh name. BadInput if their number differs from that of the
/// groups, or from the mesh or a material. Throws Failure (Interrupted) once `cancel` became true.
Result<Scene> make_scene(const Mesh &mesh, NormalMode normals, const std::vector<Band> &bands,
                         const std::vector<Material> &front, const std::vector<Material> &back,
                         Diagnostics &diagnostics, double crease_rad = default_crease_rad,
                         const std::string &file = {}, const std::atomic<bool> *cancel = nullptr);

/// The scene with each material replaced by what `change` makes of it, in the group of this name;
/// the mesh stays. BadInput from a material.
Result<Scene>
with_materials(const Scene &scene,
               const std::function<Material(const Material &, const std::string &group)> &change);

/// Direction field of a group's surface on a triangle, zero where it has none.
Vec3<Body> direction_field(const Mesh &mesh, const Surface &surface, std::size_t triangle);

/// Directions to the source and the observer in the facet frame of a unit normal; x is the field
/// made perpendicular to it (any direction where the field is zero or along the normal).
SurfaceDirections directions_on(Vec3<Body> normal, Vec3<Body> field, Vec3<Body> to_source,
                                Vec3<Body> to_observer, double cos_phase, double disk_rad);

/// Sides of a triangle that anything outside can see.
struct VisibleSides {
  bool front = true, back = true;
};

/// Per triangle: the inner side of a closed, consistently wound part (triangles joined by edges
/// that exactly two of them share, in opposite directions) is hidden by the part itself. Vertices
/// are joined if their coordinates agree within 1e-6 of the size. A part must not cut itself.
/// Throws as above.
std::vector<VisibleSides> visible_sides(const Mesh &mesh,
                                        const std::atomic<bool> *cancel = nullptr);

/// The surface of one side of a triangle. Where two opposite faces were merged into one (its back
/// is of another group), the back shows the front surface of the other face.
inline const Surface &surface_of_side(const Scene &scene, const Triangle &t, bool is_front) {
  if (is_front)
    return scene.front[t.front];
  return t.back == t.front ? scene.back[t.back] : scene.front[t.back];
}

} // namespace umov
