#include <umov/shape/topology.h>

#include <map>
#include <utility>

namespace umov {

Mesh with_joined_groups(const Mesh &mesh, const std::vector<std::size_t> &kind) {
  Mesh out = mesh;
  out.groups.clear();
  out.nodes.clear();
  std::map<std::pair<std::string, std::size_t>, std::uint32_t> known;
  std::vector<std::uint32_t> place;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    const auto [entry, is_new] =
        known.emplace(std::pair{mesh.groups[g], kind.empty() ? 0 : kind[g]},
                      static_cast<std::uint32_t>(out.groups.size()));
    place.push_back(entry->second);
    if (!is_new)
      continue;
    out.groups.push_back(mesh.groups[g]);
    if (!mesh.nodes.empty())
      out.nodes.push_back(mesh.nodes[g]);
  }
  for (Triangle &t : out.triangles) {
    t.front = place[t.front];
    t.back = place[t.back];
  }
  return out;
}

} // namespace umov
