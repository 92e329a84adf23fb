#include "jobs/body_words.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <umov/core/text.h>
#include <umov/io/scenario.h>

namespace umov::jobs {
namespace {

/// Corners to a ten-millionth of themselves: the same file in other units is another body.
std::string mesh_text(const Scene &scene) {
  const Mesh &mesh = scene.mesh;
  std::string out = scene.normals == NormalMode::Smooth ? "smooth\n" : "flat\n";
  for (const Vec3<Body> &p : mesh.positions)
    out += fmt::format("{:.7g} {:.7g} {:.7g}\n", p.x, p.y, p.z);
  for (const Triangle &t : mesh.triangles)
    out += fmt::format("{} {} {} {} {}\n", t.vertex[0], t.vertex[1], t.vertex[2], t.front, t.back);
  for (const std::string &group : mesh.groups)
    out += group + "\n";
  return out;
}

/// From one side of the box around the mesh to the other, along the longest axis [m].
double size_of(const Mesh &mesh) {
  double most = 0;
  for (const auto axis : {&Vec3<Body>::x, &Vec3<Body>::y, &Vec3<Body>::z}) {
    const auto [low, high] = std::ranges::minmax_element(
        mesh.positions, {}, [axis](const Vec3<Body> &p) { return p.*axis; });
    if (low != mesh.positions.end())
      most = std::max(most, (*high).*axis - (*low).*axis);
  }
  return most;
}

std::string material_words(const Material &material) {
  constexpr std::size_t digits = 8;
  return material.name + " " + sha256_hex(material_as_toml(material)).substr(0, digits);
}

/// "bus=mli_kapton 1a2b3c4d" and so on by the group.
std::map<std::string, std::string> by_group(const std::string &materials) {
  std::map<std::string, std::string> out;
  for (std::size_t begin = 0; begin < materials.size();) {
    const std::size_t end = std::min(materials.find("; ", begin), materials.size());
    const std::string one = materials.substr(begin, end - begin);
    const std::size_t equals = one.find('=');
    if (equals != std::string::npos)
      out[one.substr(0, equals)] = one.substr(equals + 1);
    begin = end + 2;
  }
  return out;
}

} // namespace

BodyWords body_words(const Scene &scene) {
  BodyWords out;
  constexpr std::size_t digits = 12;
  out.mesh =
      fmt::format("{}, {:.4g} m across, sha256 {}", counted(scene.mesh.triangles.size(), "facet"),
                  size_of(scene.mesh), sha256_hex(mesh_text(scene)).substr(0, digits));
  for (std::size_t g = 0; g < scene.mesh.groups.size(); ++g) {
    const std::string front = material_words(scene.front[g].material()),
                      back = material_words(scene.back[g].material());
    out.materials += (g > 0 ? "; " : "") + scene.mesh.groups[g] + "=" + front +
                     (back == front ? "" : "/" + back);
  }
  return out;
}

std::optional<std::string> difference_of(const BodyWords &there_has, const BodyWords &here_has,
                                         const std::string &there, const std::string &here) {
  if (there_has.mesh != here_has.mesh)
    return fmt::format("the mesh is another one: {} of {}, {} of {}", printable(there_has.mesh),
                       there, here_has.mesh, here);
  if (there_has.materials == here_has.materials)
    return std::nullopt;
  const auto other = by_group(there_has.materials);
  for (const auto &[group, words] : by_group(here_has.materials)) {
    const auto found = other.find(group);
    if (found == other.end() || found->second != words)
      return fmt::format("group {} is of another material: {} of {}, {} of {}", group,
                         found == other.end() ? "none" : printable(found->second), there, words,
                         here);
  }
  return fmt::format("{} has materials of groups that {} lacks", there, here);
}

} // namespace umov::jobs
