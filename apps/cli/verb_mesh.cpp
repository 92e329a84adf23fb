#include "console.h"
#include "verbs.h"

#include "tables.h"
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <umov/io/mesh_file.h>
#include <umov/shape/topology.h>

namespace umov::cli {
namespace {

struct ReadOptions {
  std::string file;
  MeshFileOptions frame;
  bool require_closed = false;
};

Table group_table(const Mesh &mesh, const MeshReport &found) {
  Table table;
  std::vector<std::string> names = mesh.groups;
  std::vector<std::int64_t> triangles;
  for (const std::size_t count : found.group_triangles)
    triangles.push_back(static_cast<std::int64_t>(count));
  table.add("material", "", "mesh material", std::move(names));
  table.add("triangles", "", "number of triangles", std::move(triangles));
  table.add("area", "m2", "area of one side", found.group_area_m2);
  return table;
}

/// Nodes of the file's tree: the parts of a scenario may name them.
Table node_table(const std::vector<MeshNode> &nodes) {
  Table table;
  std::vector<std::string> paths;
  std::vector<std::int64_t> triangles;
  std::array<std::vector<double>, 3> origin;
  for (const MeshNode &node : nodes) {
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

void describe(const MeshReport &m, const std::string &format) {
  fmt::print("format        {}\nbounding box  {:.6g} x {:.6g} x {:.6g} m\n", format,
             m.upper.x - m.lower.x, m.upper.y - m.lower.y, m.upper.z - m.lower.z);
  fmt::print("vertices      {}\ntriangles     {} in {} parts\narea          {:.6g} m2\n",
             m.vertices, m.triangles, m.parts, m.area_m2);
  if (m.is_closed)
    fmt::print("volume        {:.6g} m3\n", m.volume_m3);
  fmt::print("closed        {}\nconvex        {}\n", m.is_closed ? "yes" : "no",
             m.is_convex ? "yes" : "no");
  fmt::print("open edges {}, non-manifold edges {}, inconsistent edges {}, inward parts {}\n",
             m.open_edges, m.non_manifold_edges, m.inconsistent_edges, m.inward_parts);
  fmt::print("degenerate {}, duplicates {}, opposite pairs {}\n\n", m.degenerate, m.duplicate,
             m.opposite_pairs);
}

std::string to_json(const Mesh &mesh, const MeshReport &m, const MeshFile &file) {
  const auto vector = [](Vec3<Body> v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  nlohmann::ordered_json out{{"format", file.format},
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
  for (const MeshNode &node : file.nodes)
    out["nodes"].push_back(
        {{"path", node.path}, {"triangles", node.triangles}, {"origin_m", vector(node.origin_m)}});
  return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<void> describe_file(const ReadOptions &options, const Common &common, bool check,
                           Diagnostics &diagnostics) {
  UMOV_ASSIGN(read, read_mesh(options.file, options.frame, diagnostics));
  Mesh mesh = with_joined_groups(read.mesh);
  const MeshReport raw = inspect(mesh);
  if (check) { // what is left when a scene is made of it
    UMOV_ASSIGN(cleaned, clean_mesh(mesh, diagnostics, options.file));
    mesh = std::move(cleaned);
  }
  MeshReport found = inspect(mesh, false);
  found.degenerate = raw.degenerate;
  found.duplicate = raw.duplicate;
  found.opposite_pairs = raw.opposite_pairs;
  if (common.json) {
    UMOV_TRY(put("", to_json(mesh, found, read)));
  } else {
    describe(found, read.format);
    UMOV_TRY(put("", to_text(group_table(mesh, found))));
    if (!read.nodes.empty())
      UMOV_TRY(put("", "\n" + to_text(node_table(read.nodes))));
  }
  if (options.require_closed && !found.is_closed)
    return fail(ErrorCode::BadInput,
                fmt::format("not closed: {} open and {} non-manifold edges. Mend the mesh or leave "
                            "--require-closed out.",
                            found.open_edges, found.non_manifold_edges),
                {options.file});
  return {};
}

Result<void> look(const ReadOptions &options, const Common &common, bool check) {
  Diagnostics diagnostics;
  auto done = describe_file(options, common, check, diagnostics);
  report(diagnostics, common); // also where the file could not be read: they may say why
  return done;
}

void add_input(CLI::App &verb, ReadOptions &options) {
  verb.add_option("file", options.file,
                  "Mesh: OBJ, glTF, GLB, STL, PLY, COLLADA (.dae), 3DS or OFF")
      ->required();
  verb.add_option("--unit", options.frame.unit,
                  "Unit of the file: m, cm, mm, km, in, ft; glTF and COLLADA state it");
  verb.add_option("--up", options.frame.up,
                  "Axis of the file that becomes body +Z, such as +Y; glTF and COLLADA state it");
}

Result<void> convert(const ReadOptions &options, const std::string &output,
                     Diagnostics &diagnostics) {
  UMOV_ASSIGN(read, read_mesh(options.file, options.frame, diagnostics));
  return write_mesh(output, read.mesh, diagnostics);
}

void add_convert(CLI::App &mesh, const Exit &exit_with) {
  auto *verb = mesh.add_subcommand("convert", "Write a mesh in another format, in metres, +Z up "
                                              "(glTF: +Y up)");
  auto options = std::make_shared<ReadOptions>();
  auto common = std::make_shared<Common>();
  auto output = std::make_shared<std::string>();
  add_input(*verb, *options);
  verb->add_option("-o,--output", *output,
                   "File to write; the suffix says how: .obj (its MTL beside it), .glb, .gltf, "
                   ".stl, .ply")
      ->required();
  add_common(*verb, *common, false);
  verb->callback([options, common, output, exit_with] {
    Diagnostics diagnostics;
    const auto done = convert(*options, *output, diagnostics);
    report(diagnostics, *common);
    exit_with(done ? 0 : report(done.error()));
  });
}

void add_look(CLI::App &mesh, const Exit &exit_with, bool check) {
  auto *verb = mesh.add_subcommand(check ? "check" : "info",
                                   check ? "Say what is wrong with a mesh"
                                         : "Bounding box, parts, area per material");
  auto options = std::make_shared<ReadOptions>();
  auto common = std::make_shared<Common>();
  add_input(*verb, *options);
  if (check)
    verb->add_flag("--require-closed", options->require_closed, "Fail if the mesh is not closed");
  add_common(*verb, *common, true);
  verb->callback([options, common, exit_with, check] {
    const auto done = look(*options, *common, check);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace

void add_mesh(CLI::App &app, const Exit &exit_with) {
  auto *mesh = app.add_subcommand("mesh", "Make, describe, check and convert meshes");
  mesh->require_subcommand(1);
  add_mesh_make(*mesh, exit_with);
  add_look(*mesh, exit_with, false);
  add_look(*mesh, exit_with, true);
  add_convert(*mesh, exit_with);
}

} // namespace umov::cli
