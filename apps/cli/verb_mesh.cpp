#include "console.h"
#include "verbs.h"

#include "tables.h"
#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <umov/core/files.h>
#include <umov/core/quantity.h>
#include <umov/io/obj.h>
#include <umov/shape/primitives.h>
#include <umov/shape/rough_surface.h>
#include <umov/shape/topology.h>

namespace umov::cli {
namespace {

namespace fs = std::filesystem;

/// Sizes of the shapes; each shape uses those that its help line names.
struct ShapeOptions {
  std::string shape, output;
  double radius = 1, length = 2, width = 1, height = 1, edge = 1, chamfer = 0.1;
  std::vector<double> semi_axes{0.25, 0.25, 1};
  int facets = 5000, sides = 48;
  double array_angle_deg = 0, crumple = 0, crumple_slope = 0;
  bool two_sided = false;
  RoughSurfaceOptions rough;
};

using Maker = std::function<Mesh(const ShapeOptions &)>;

const std::map<std::string, Maker> &makers() {
  static const std::map<std::string, Maker> all{
      {"sphere",
       [](const auto &o) { return make_sphere(o.radius, static_cast<std::size_t>(o.facets)); }},
      {"plate", [](const auto &o) { return make_plate(o.width, o.height, o.two_sided); }},
      {"mli", [](const auto &o) { return make_mli_sheet(o.width, o.crumple_slope); }},
      {"cylinder",
       [](const auto &o) {
         return make_cylinder(o.radius, o.length, static_cast<std::size_t>(o.sides));
       }},
      {"chamfered-cube", [](const auto &o) { return make_chamfered_cube(o.edge, o.chamfer); }},
      {"cigar",
       [](const auto &o) {
         return make_ellipsoid(o.semi_axes[0], o.semi_axes[1], o.semi_axes[2],
                               static_cast<std::size_t>(o.facets));
       }},
      {"hst",
       [](const auto &o) {
         HstOptions hst;
         hst.sides = static_cast<std::size_t>(o.sides);
         hst.array_angle_rad = o.array_angle_deg * pi / 180;
         return make_hst(hst);
       }},
      {"box-wing",
       [](const auto &o) {
         return make_box_wing(
             {.facets = static_cast<std::size_t>(o.facets), .crumple_m = o.crumple});
       }},
      {"agena",
       [](const auto &o) { return make_agena({.sides = static_cast<std::size_t>(o.sides)}); }},
  };
  return all;
}

Result<Mesh> mesh_for(const ShapeOptions &options) {
  if (options.shape != "rough-surface")
    return makers().at(options.shape)(options);
  UMOV_ASSIGN(field, make_height_field(options.rough));
  return mesh_of(field);
}

Result<void> make(const ShapeOptions &options) {
  UMOV_ASSIGN(mesh, mesh_for(options));
  if (options.output.empty() || options.output == "-")
    return put("", write_obj(mesh, options.shape, MtlUse::None).obj);
  const fs::path path = options.output;
  if (path.extension() != ".obj")
    return fail(ErrorCode::Usage, "-o " + options.output +
                                      ": a name that ends in .obj was expected (umov mesh convert "
                                      "makes other formats of it)");
  Diagnostics diagnostics;
  return write_mesh(path, mesh, diagnostics);
}

void add_rough_surface(CLI::App &verb, RoughSurfaceOptions &rough) {
  verb.add_option("--cells", rough.cells, "rough-surface: cells per side")->capture_default_str();
  verb.add_option("--cell", rough.cell_m, "rough-surface: side of a cell [m]")
      ->check(CLI::Range(1e-6, 1e6))
      ->capture_default_str();
  verb.add_option("--slope", rough.slope, "rough-surface: rms slope along an axis")
      ->capture_default_str();
  verb.add_option("--correlation", rough.correlation_cells,
                  "rough-surface: correlation length [cells]")
      ->capture_default_str();
  verb.add_option("--hurst", rough.hurst, "rough-surface: Hurst exponent; 0: one scale")
      ->capture_default_str();
  verb.add_option("--seed", rough.seed, "rough-surface: of the heights")->capture_default_str();
}

void add_make(CLI::App &mesh, const Exit &exit_with) {
  auto *verb = mesh.add_subcommand("make", "Make a shape as OBJ and MTL, in metres, +Z up");
  auto options = std::make_shared<ShapeOptions>();
  auto common = std::make_shared<Common>();
  std::vector<std::string> names;
  for (const auto &[name, maker] : makers())
    names.push_back(name);
  names.emplace_back("rough-surface");
  verb->add_option("shape", options->shape,
                   "sphere (--radius --facets), plate (--width --height --two-sided), "
                   "mli (--width --crumple-slope), cylinder "
                   "(--radius --length --sides), chamfered-cube (--edge --chamfer), cigar "
                   "(--semi-axes --facets), hst (--sides --array-angle-deg), agena (--sides), "
                   "box-wing (--facets --crumple), "
                   "rough-surface (--cells "
                   "--cell --slope --correlation --hurst --seed)")
      ->required()
      ->check(CLI::IsMember(names));
  verb->add_option("-o,--output", options->output, "OBJ file; the MTL goes beside it");
  const auto length = CLI::Range(1e-6, 1e6);
  verb->add_option("--radius", options->radius, "[m]")->check(length)->capture_default_str();
  verb->add_option("--length", options->length, "[m]")->check(length)->capture_default_str();
  verb->add_option("--width", options->width, "[m]")->check(length)->capture_default_str();
  verb->add_option("--height", options->height, "[m]")->check(length)->capture_default_str();
  verb->add_option("--edge", options->edge, "[m]")->check(length)->capture_default_str();
  verb->add_option("--chamfer", options->chamfer, "[m], below half the edge")
      ->check(length)
      ->capture_default_str();
  verb->add_option("--semi-axes", options->semi_axes, "a b c [m]")
      ->expected(3)
      ->check(length)
      ->capture_default_str();
  verb->add_option("--facets", options->facets, "At least so many triangles")
      ->check(CLI::Range(8, 5'000'000))
      ->capture_default_str();
  verb->add_option("--sides", options->sides, "Sides of round parts")
      ->check(CLI::Range(8, 4096))
      ->capture_default_str();
  verb->add_option("--crumple", options->crumple,
                   "box-wing: height of the folds of the bus's foil [m]")
      ->check(CLI::Range(0.0, 0.05))
      ->capture_default_str();
  verb->add_option("--crumple-slope", options->crumple_slope, "mli: rms slope of its folds")
      ->check(CLI::Range(0.0, 3.0))
      ->capture_default_str();
  verb->add_option("--array-angle-deg", options->array_angle_deg,
                   "Turn of the solar arrays about their boom")
      ->capture_default_str();
  add_rough_surface(*verb, options->rough);
  verb->add_flag("--two-sided", options->two_sided, "Materials \"front\" and \"back\"");
  add_common(*verb, *common, false);
  verb->callback([options, exit_with] {
    if (options->shape == "chamfered-cube" && 2 * options->chamfer >= options->edge) {
      exit_with(report(Error{ErrorCode::Usage, "--chamfer must be below half of --edge", {}}));
      return;
    }
    const auto done = make(*options);
    exit_with(done ? 0 : report(done.error()));
  });
}

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
  MeshReport found = inspect(mesh);
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
  add_make(*mesh, exit_with);
  add_look(*mesh, exit_with, false);
  add_look(*mesh, exit_with, true);
  add_convert(*mesh, exit_with);
}

} // namespace umov::cli
