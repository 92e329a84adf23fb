#pragma once
// Private: what the readers of all formats share.

#include <array>
#include <map>
#include <span>
#include <string>
#include <umov/io/mesh_file.h>
#include <utility>
#include <vector>

namespace umov::mesh_io {

inline constexpr double farthest = 1e12; ///< beyond it areas lose their meaning [units of the file]

/// True where a coordinate is NaN, infinite or beyond `farthest`.
bool is_out_of_reach(Vec3<Body> v);
/// "(1, nan, 3)" for messages.
std::string point_text(Vec3<Body> v);
/// True if a name could lead out of the folder of the mesh.
bool leaves_folder(const std::string &name);
/// A name of a file as one line: control characters become '_', blanks at the ends are dropped.
std::string clean_name(std::string_view name);

/// The path of a node with that name below another one ("": the root).
std::string joined_path(const std::string &parent, const std::string &name);

/// Numbers of the groups of a mesh, one for each pair of name and node.
class GroupIndex {
public:
  explicit GroupIndex(Mesh &mesh) : mesh_(mesh) {}
  std::uint32_t of(const std::string &name);
  /// With a tree; never mixed with the other one.
  std::uint32_t of(const std::string &name, const std::string &node);

private:
  Mesh &mesh_;
  std::map<std::pair<std::string, std::string>, std::uint32_t> known_;
};

/// Direction in which the first texture coordinate grows over a triangle; zero where none does.
Vec3<Body> texture_tangent(const std::array<Vec3<Body>, 3> &at,
                           const std::array<std::array<double, 2>, 3> &uv);

/// Corners of a polygon: cutting ears takes their number squared.
inline constexpr std::size_t corners_max = 10'000;

/// A corner of a polygon: indices into the positions and normals of the mesh and the texture
/// coordinates of the maker.
struct Corner {
  std::uint32_t vertex = no_index, normal = no_index, texture = no_index;
};

/// Makes triangles of polygons, with their tangents, and counts the odd ones.
class PolygonMaker {
public:
  PolygonMaker(Mesh &mesh, const MeshFileOptions &options)
      : mesh_(mesh), max_triangles_(options.max_triangles), cancel_(options.cancel) {}

  /// BadInput where the mesh or the polygon is beyond its limit. Fewer than three corners are
  /// counted only. Throws Failure (Interrupted) where MeshFileOptions::cancel came true.
  Result<void> add(std::span<const Corner> corners, std::uint32_t group, const Where &where);
  /// Tells of polygons that were skipped or odd.
  void warn(Diagnostics &diagnostics, const Where &file) const;
  /// Drops the tangents of a mesh without texture coordinates.
  void finish();

  std::vector<std::array<double, 2>> textures; ///< u, v

private:
  [[nodiscard]] Vec3<Body> tangent(const std::array<Corner, 3> &corners) const;

  Mesh &mesh_;
  std::size_t max_triangles_;
  const std::atomic<bool> *cancel_;
  std::size_t added_ = 0, short_faces_ = 0, concave_ = 0, crossed_ = 0, bent_ = 0;
};

/// The refusal of a mesh that is too large.
tl::unexpected<Error> too_many_triangles(std::size_t max_triangles, Where where);

/// Metres and body axes for a mesh as it stands in its file, unit normals, and a warning of a
/// doubtful size. BadInput without faces, or where unit or up are missing or unknown.
Result<void> to_body_frame(MeshFile &read, const MeshFileOptions &options, const std::string &file,
                           Diagnostics &diagnostics);

/// Makes positions and normals that are equal to the bit one, and drops those that no triangle
/// uses: formats without shared vertices, or with seams, give each corner its own. Throws Failure
/// (Interrupted) once `cancel`, which may be null, became true.
void join_equal(Mesh &mesh, const std::atomic<bool> *cancel);

} // namespace umov::mesh_io
