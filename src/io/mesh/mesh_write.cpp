// Writers of STL and PLY. Coordinates are rounded to 32 bits where the format wants it.

#include "io/mesh/bytes.h"
#include "io/mesh/readers.h"

#include <array>
#include <fmt/format.h>
#include <map>

namespace umov::mesh_io {
namespace {

void append_vector(std::string &out, Vec3<Body> v) {
  for (const double value : {v.x, v.y, v.z})
    append(out, static_cast<float>(value));
}

/// Calls for each side that has a material of its own: two-sided faces are written as two.
template <class Take> void for_each_side(const Mesh &mesh, const Take &take) {
  for (const Triangle &t : mesh.triangles) {
    take(t, std::array<std::size_t, 3>{0, 1, 2});
    if (t.back != t.front)
      take(t, std::array<std::size_t, 3>{0, 2, 1});
  }
}

} // namespace

std::string write_stl(const Mesh &mesh) {
  std::string out = "umov: metres, +Z up";
  out.resize(80, ' ');
  std::uint32_t count = 0;
  for_each_side(mesh, [&](const Triangle &, const auto &) { ++count; });
  append(out, count);
  for_each_side(mesh, [&](const Triangle &t, const auto &order) {
    std::array<Vec3<Body>, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = mesh.positions[t.vertex[order[k]]];
    const Vec3<Body> n = cross(p[1] - p[0], p[2] - p[0]);
    append_vector(out, norm(n) > 0 ? normalized(n) : Vec3<Body>{});
    for (const Vec3<Body> one : p)
      append_vector(out, one);
    append(out, std::uint16_t{0});
  });
  return out;
}

std::string write_ply(const Mesh &mesh) {
  // A vertex of the file has one normal: corners that differ in it become vertices of their own.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> place;
  std::string vertices, faces;
  bool has_normals = !mesh.normals.empty();
  for (const Triangle &t : mesh.triangles)
    has_normals = has_normals && t.normal[0] != no_index;
  std::uint32_t count = 0;
  for_each_side(mesh, [&](const Triangle &t, const auto &order) {
    append(faces, std::uint8_t{3});
    for (const std::size_t k : order) {
      const std::uint32_t normal = has_normals ? t.normal[k] : no_index;
      const auto [entry, is_new] =
          place.emplace(std::pair{t.vertex[k], normal}, static_cast<std::uint32_t>(place.size()));
      if (is_new) {
        const Vec3<Body> p = mesh.positions[t.vertex[k]];
        for (const double value : {p.x, p.y, p.z})
          append(vertices, value);
        if (has_normals)
          append_vector(vertices, mesh.normals[normal]);
      }
      append(faces, entry->second);
    }
    ++count;
  });
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment umov: metres, +Z up\n";
  out += fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
                     place.size());
  if (has_normals)
    out += "property float nx\nproperty float ny\nproperty float nz\n";
  out +=
      fmt::format("element face {}\nproperty list uchar uint vertex_indices\nend_header\n", count);
  return out + vertices + faces;
}

} // namespace umov::mesh_io
