// umov mesh make: shapes of given sizes.

#include "console.h"
#include "finishing.h"
#include "mesh_shapes.h"
#include "verbs.h"

#include <filesystem>
#include <umov/io/mesh_file.h>
#include <umov/io/obj.h>

namespace umov::cli {
namespace {

namespace fs = std::filesystem;

Result<void> make(const ShapeOptions &options) {
  UMOV_ASSIGN(mesh, make_shape(options));
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
  verb.add_option("--bus", o.bus, "box-wing: x y z [m]")
      ->expected(3)
      ->delimiter(',')
      ->check(length);
  verb.add_option("--wing", o.wing, "box-wing: length along y and width of a wing [m]")
      ->expected(2)
      ->delimiter(',')
      ->check(length);
  verb.add_option("--yoke", o.yoke, "box-wing: from bus to wing [m]")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  verb.add_option("--diameter", o.diameter, "rocket-body, dish: [m]")
      ->check(length)
      ->capture_default_str();
  verb.add_option("--nozzle", o.nozzle, "rocket-body: length and diameter of its nozzle [m]")
      ->expected(2)
      ->delimiter(',')
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
  verb->add_option("shape", options->shape,
                   "sphere (--radius --facets), plate (--width --height --two-sided), "
                   "mli (--width --crumple-slope), cylinder "
                   "(--radius --length --sides), chamfered-cube (--edge --chamfer), cigar "
                   "(--semi-axes --facets), hst (--sides --array-angle-deg), agena (--sides), "
                   "box-wing (--bus --wing --yoke: a group for each face and side, fronts of the "
                   "wings to +Z; or --facets "
                   "--crumple: the benchmark's), cubesat (--units --panels), rocket-body (--length "
                   "--diameter --nozzle --sides), dish (--diameter --focus --sides), "
                   "rough-surface (--cells "
                   "--cell --slope --correlation --hurst --seed)")
      ->required()
      ->check(CLI::IsMember(shape_names()));
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
      ->delimiter(',')
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
  verb->callback(finishing(exit_with, [options]() -> Result<void> {
    if (options->shape == "chamfered-cube" && 2 * options->chamfer >= options->edge)
      return fail(ErrorCode::Usage, "--chamfer must be below half of --edge");
    return make(*options);
  }));
}

} // namespace umov::cli
