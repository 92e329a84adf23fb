#include "console.h"
#include "finishing.h"
#include "verbs.h"

#include "tables.h"
#include <fmt/format.h>
#include <umov/io/mesh_file.h>
#include <umov/io/table_sink.h>
#include <umov/jobs/mesh_description.h>

namespace umov::cli {
namespace {

struct ReadOptions {
  std::string file, output;
  MeshFileOptions frame;
  bool require_closed = false;
};

void print(const jobs::MeshDescription &mesh) {
  const MeshReport &m = mesh.report;
  fmt::print("format        {}\nbounding box  {:.6g} x {:.6g} x {:.6g} m\n", mesh.format,
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

/// To a file: all of it as JSON, else the table of materials.
Result<void> keep(const std::string &path, const jobs::MeshDescription &mesh) {
  return path.ends_with(".json") ? put(path, jobs::to_json(mesh))
                                 : write_table(path, jobs::group_table(mesh));
}

Result<void> describe_file(const ReadOptions &options, const Common &common, bool check,
                           Diagnostics &diagnostics) {
  UMOV_TRY(check_output(options.output));
  UMOV_TRY(check_apart({options.file}, {options.output}));
  const bool has_file = !options.output.empty() && options.output != "-";
  const auto how = check ? jobs::MeshLook::Cleaned : jobs::MeshLook::AsRead;
  UMOV_ASSIGN(mesh, jobs::describe_mesh(options.file, options.frame, how, diagnostics));
  if (has_file) {
    UMOV_TRY(keep(options.output, mesh));
  } else if (common.json) {
    UMOV_TRY(put("", jobs::to_json(mesh)));
  } else {
    print(mesh);
    UMOV_TRY(put("", to_text(jobs::group_table(mesh))));
    if (!mesh.nodes.empty())
      UMOV_TRY(put("", "\n" + to_text(jobs::node_table(mesh))));
  }
  const MeshReport &found = mesh.report;
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
  options.frame.is_of_command = true;
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
  verb->callback(finishing(exit_with, common, [options, common, output](Diagnostics &diagnostics) {
    return convert(*options, *output, diagnostics);
  }));
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
  verb->add_option("-o,--output", options->output,
                   "File, instead of stdout: .json has all, a table (.csv, .ecsv, .fits) the "
                   "materials");
  add_common(*verb, *common, true);
  verb->callback(
      finishing(exit_with, [options, common, check] { return look(*options, *common, check); }));
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
