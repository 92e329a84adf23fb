#pragma once
// What a mesh is like and what is wrong with it; mending what has one clear meaning.

#include <atomic>
#include <cstdint>
#include <string>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>
#include <umov/shape/mesh.h>
#include <vector>

namespace umov {

/// What was found out about a mesh.
struct MeshReport {
  Vec3<Body> lower{}, upper{};       ///< bounding box [m]
  std::vector<double> group_area_m2; ///< one-sided area of each group
  std::vector<std::size_t> group_triangles;
  double area_m2 = 0;
  double volume_m3 = 0; ///< signed, meaningful if closed
  std::size_t vertices = 0, triangles = 0, parts = 0;
  std::size_t degenerate = 0, duplicate = 0, opposite_pairs = 0;
  std::size_t open_edges = 0, non_manifold_edges = 0, inconsistent_edges = 0;
  std::size_t inward_parts = 0; ///< closed parts wound inside out
  bool is_closed = false;       ///< no open or non-manifold edge after welding
  bool is_convex = false;       ///< closed, one part, outward, no vertex above any face plane
};

/// Looks at a mesh, vertices welded at 1e-6 of its size. Never changes it. Without
/// `with_coincidence`, `duplicate` and `opposite_pairs` stay 0: looking for what lies upon what
/// takes seconds for millions of faces. Throws Failure (Interrupted), here and below, once `cancel`
/// became true.
MeshReport inspect(const Mesh &mesh, bool with_coincidence = true,
                   const std::atomic<bool> *cancel = nullptr);

/// Drops zero-area triangles and repeated faces, merges coincident faces of opposite winding into
/// one two-sided face (front and back groups from the two), however the polygons are cut into
/// triangles; each with a counted warning. Overlaps in one plane that are left because the outlines
/// differ are named with their groups and area.
/// BadInput if a coordinate is not finite, an index is out of range or nothing is left.
Result<Mesh> clean_mesh(const Mesh &mesh, Diagnostics &diagnostics, const std::string &file = {},
                        const std::atomic<bool> *cancel = nullptr);

/// The mesh with all groups of one name and one `kind` (a number per group; none: all alike) made
/// one, which keeps the node of the first.
Mesh with_joined_groups(const Mesh &mesh, const std::vector<std::size_t> &kind = {});

/// Vertex normals for `normals = "smooth"` where the mesh has none: the mean over the
/// faces that meet at a vertex within `crease_rad` of each other and belong to one group, weighted
/// after Max (1999), which is exact on a sphere.
Mesh with_vertex_normals(const Mesh &mesh, double crease_rad,
                         const std::atomic<bool> *cancel = nullptr);

/// True only if no point of the surface can hide another: `is_convex`, or a single flat sheet.
bool is_proven_convex(const Mesh &mesh, const std::atomic<bool> *cancel = nullptr);

/// Area projected along the unit direction, hidden parts not counted twice only if convex: half the
/// sum of |n.d| A over both sides of a closed mesh, the sum over an open sheet's faces otherwise.
double silhouette_upper_bound(const Mesh &mesh, Vec3<Body> direction);

} // namespace umov
