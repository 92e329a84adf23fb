// umov mesh make: shapes of given sizes.

#include "console.h"
#include "verbs.h"

#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <umov/core/quantity.h>
#include <umov/io/mesh_file.h>
#include <umov/io/obj.h>
#include <umov/shape/primitives.h>
#include <umov/shape/rough_surface.h>

namespace umov::cli {
namespace {

namespace fs = std::filesystem;

/// Sizes of the shapes; each shape uses those that its help line names.
struct ShapeOptions {
  std::string shape, output;
  double radius = 1, length = 2, width = 1, height = 1, edge = 1, chamfer = 0.1;
  std::vector<double> semi_axes{0.25, 0.25, 1};
  int facets = 5000, sides = 48, units = 3, panels = 0;
  std::vector<double> bus, wing;
  double diameter = 2, yoke = 0.5, focus = 0.8;
  std::vector<double> nozzle{1, 0.8};
  double array_angle_deg = 0, crumple = 0, crumple_slope = 0;
  bool two_sided = false;
  RoughSurfaceOptions rough;
};

using Maker = std::function<Mesh(const ShapeOptions &)>;

SatelliteOptions satellite_of(const ShapeOptions &o) {
  SatelliteOptions out;
  if (!o.bus.empty())
    out.bus_m = {o.bus[0], o.bus[1], o.bus[2]};
  if (!o.wing.empty()) {
    out.wing_length_m = o.wing[0];
    out.wing_width_m = o.wing[1];
  }
  out.yoke_m = o.yoke;
  return out;
}

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
         return o.bus.empty() && o.wing.empty()
                    ? make_box_wing(
                          {.facets = static_cast<std::size_t>(o.facets), .crumple_m = o.crumple})
                    : make_satellite(satellite_of(o));
       }},
      {"cubesat",
       [](const auto &o) {
         return make_cubesat({.units = static_cast<std::size_t>(o.units),
                              .panels = static_cast<std::size_t>(o.panels)});
       }},
      {"rocket-body",
       [](const auto &o) {
         return make_rocket_body({.length_m = o.length,
                                  .diameter_m = o.diameter,
                                  .nozzle_length_m = o.nozzle[0],
                                  .nozzle_diameter_m = o.nozzle[1],
                                  .sides = static_cast<std::size_t>(o.sides)});
       }},
      {"dish",
       [](const auto &o) {
         return make_dish({.diameter_m = o.diameter,
                           .focus_m = o.focus,
                           .sides = static_cast<std::size_t>(o.sides)});
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

void add_spacecraft(CLI::App &verb, ShapeOptions &o) {
  const auto length = CLI::Range(1e-3, 1e3);
  verb.add_option("--units", o.units, "cubesat: 1, 2, 3, 6 or 12")
      ->check(CLI::IsMember({1, 2, 3, 6, 12}))
      ->capture_default_str();
  verb.add_option("--panels", o.panels, "cubesat: deployed panels, to +x, -x, +y, -y")
      ->check(CLI::Range(0, 4))
      ->capture_default_str();
  verb.add_option("--bus", o.bus, "box-wing: x y z [m]")->expected(3)->check(length);
  verb.add_option("--wing", o.wing, "box-wing: length along y and width of a wing [m]")
      ->expected(2)
      ->check(length);
  verb.add_option("--yoke", o.yoke, "box-wing: from bus to wing [m]")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  verb.add_option("--diameter", o.diameter, "rocket-body, dish: [m]")
      ->check(length)
      ->capture_default_str();
  verb.add_option("--nozzle", o.nozzle, "rocket-body: length and diameter of its nozzle [m]")
      ->expected(2)
      ->check(length)
      ->capture_default_str();
  verb.add_option("--focus", o.focus, "dish: focal length [m]")
      ->check(length)
      ->capture_default_str();
}

void add_foil_and_arrays(CLI::App &verb, ShapeOptions &o) {
  verb.add_option("--crumple", o.crumple, "box-wing: height of the folds of the bus's foil [m]")
      ->check(CLI::Range(0.0, 0.05))
      ->capture_default_str();
  verb.add_option("--crumple-slope", o.crumple_slope, "mli: rms slope of its folds")
      ->check(CLI::Range(0.0, 3.0))
      ->capture_default_str();
  verb.add_option("--array-angle-deg", o.array_angle_deg,
                  "Turn of the solar arrays about their boom")
      ->capture_default_str();
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

} // namespace

void add_mesh_make(CLI::App &mesh, const Exit &exit_with) {
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
                   "box-wing (--bus --wing --yoke: a group for each face and side; or --facets "
                   "--crumple: the benchmark's), cubesat (--units --panels), rocket-body (--length "
                   "--diameter --nozzle --sides), dish (--diameter --focus --sides), "
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
  add_foil_and_arrays(*verb, *options);
  add_spacecraft(*verb, *options);
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

} // namespace umov::cli
