#pragma once
// The shapes of `umov mesh make`.

#include <string>
#include <umov/core/result.h>
#include <umov/shape/mesh.h>
#include <umov/shape/rough_surface.h>
#include <vector>

namespace umov::cli {

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

/// Names of all shapes.
std::vector<std::string> shape_names();
/// The shape that the options name. BadInput for a rough surface that cannot be.
Result<Mesh> make_shape(const ShapeOptions &options);

} // namespace umov::cli
