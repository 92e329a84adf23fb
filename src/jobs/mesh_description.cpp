#include <umov/jobs/mesh_description.h>

#include <array>
#include <nlohmann/json.hpp>
#include <umov/core/stop.h>

namespace umov::jobs {

Result<MeshDescription> describe_mesh(const std::string &path, const MeshFileOptions &options,
                                      MeshLook look, Diagnostics &diagnostics) {
  return without_failures([&]() -> Result<MeshDescription> {
    UMOV_ASSIGN(read, read_mesh(path, options, diagnostics));
    Mesh mesh = with_joined_groups(read.mesh);
    const MeshReport raw = inspect(mesh, true, options.cancel);
    if (look == MeshLook::Cleaned) {
      UMOV_ASSIGN(cleaned, clean_mesh(mesh, diagnostics, path, options.cancel));
      mesh = std::move(cleaned);
    }
    MeshDescription out{read.format, mesh.groups, read.nodes, inspect(mesh, false, options.cancel)};
    out.report.degenerate = raw.degenerate;
    out.report.duplicate = raw.duplicate;
    out.report.opposite_pairs = raw.opposite_pairs;
    return out;
  });
}

Table group_table(const MeshDescription &mesh) {
  Table table;
  std::vector<std::string> names = mesh.groups;
  std::vector<std::int64_t> triangles;
  for (const std::size_t count : mesh.report.group_triangles)
    triangles.push_back(static_cast<std::int64_t>(count));
  table.add("material", "", "mesh material", std::move(names));
  table.add("triangles", "", "number of triangles", std::move(triangles));
  table.add("area", "m2", "area of one side", mesh.report.group_area_m2);
  return table;
}

Table node_table(const MeshDescription &mesh) {
  Table table;
  std::vector<std::string> paths;
  std::vector<std::int64_t> triangles;
  std::array<std::vector<double>, 3> origin;
  for (const MeshNode &node : mesh.nodes) {
    paths.push_back(node.path);
    triangles.push_back(static_cast<std::int64_t>(node.triangles));
    for (std::size_t axis = 0; axis < 3; ++axis)
      origin[axis].push_back(std::array{node.origin_m.x, node.origin_m.y, node.origin_m.z}[axis]);
  }
  table.add("node", "", "path in the tree of the file", std::move(paths));
  table.add("triangles", "", "number of triangles", std::move(triangles));
  for (std::size_t axis = 0; axis < 3; ++axis)
    table.add(std::string("origin_") + "xyz"[axis], "m", "origin of the node, body axes",
              std::move(origin[axis]));
  return table;
}

std::string to_json(const MeshDescription &mesh) {
  const MeshReport &m = mesh.report;
  const auto vector = [](Vec3<Body> v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  nlohmann::ordered_json out{{"format", mesh.format},
                             {"lower_m", vector(m.lower)},
                             {"upper_m", vector(m.upper)},
                             {"vertices", m.vertices},
                             {"triangles", m.triangles},
                             {"parts", m.parts},
                             {"area_m2", m.area_m2},
                             {"closed", m.is_closed},
                             {"convex", m.is_convex},
                             {"volume_m3", nullptr},
                             {"open_edges", m.open_edges},
                             {"non_manifold_edges", m.non_manifold_edges},
                             {"inconsistent_edges", m.inconsistent_edges},
                             {"inward_parts", m.inward_parts},
                             {"degenerate", m.degenerate},
                             {"duplicates", m.duplicate},
                             {"opposite_pairs", m.opposite_pairs}};
  if (m.is_closed)
    out["volume_m3"] = m.volume_m3;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    out["materials"].push_back({{"name", mesh.groups[g]},
                                {"triangles", m.group_triangles[g]},
                                {"area_m2", m.group_area_m2[g]}});
  for (const MeshNode &node : mesh.nodes)
    out["nodes"].push_back(
        {{"path", node.path}, {"triangles", node.triangles}, {"origin_m", vector(node.origin_m)}});
  return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace umov::jobs
