#include <umov/io/obj.h>

#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {
namespace {

void write_corner(std::string &out, std::uint32_t vertex, std::uint32_t normal) {
  out += fmt::format(" {}", vertex + 1);
  if (normal != no_index)
    out += fmt::format("//{}", normal + 1);
}

void write_face(std::string &out, const Triangle &t, std::array<std::size_t, 3> order) {
  out += "f";
  for (const std::size_t k : order)
    write_corner(out, t.vertex[k], t.normal[k]);
  out += "\n";
}

} // namespace

ObjText write_obj(const Mesh &mesh, const std::string &name, MtlUse mtl) {
  ObjText text;
  text.obj = fmt::format("# {}: metres, +Z up\n", name);
  if (mtl == MtlUse::Named)
    text.obj += fmt::format("mtllib {}.mtl\n", name);
  text.obj += fmt::format("o {}\n", name);
  for (const Vec3<Body> &p : mesh.positions)
    text.obj += "v " + shortest(p.x) + " " + shortest(p.y) + " " + shortest(p.z) + "\n";
  for (const Vec3<Body> &n : mesh.normals)
    text.obj += "vn " + shortest(n.x) + " " + shortest(n.y) + " " + shortest(n.z) + "\n";
  std::uint32_t current = no_index;
  const auto use = [&](std::uint32_t group) {
    if (group != current)
      text.obj += "usemtl " + mesh.groups[group] + "\n";
    current = group;
  };
  for (const Triangle &t : mesh.triangles) {
    use(t.front);
    write_face(text.obj, t, {0, 1, 2});
    if (t.back != t.front) { // OBJ has no two-sided face: the same one, wound the other way
      use(t.back);
      write_face(text.obj, t, {0, 2, 1});
    }
  }
  text.mtl = fmt::format("# {}: names only; umov maps them to its own materials\n", name);
  for (const std::string &group : mesh.groups)
    text.mtl += "newmtl " + group + "\nKd 0.7 0.7 0.7\n";
  return text;
}

} // namespace umov
