#include "mesh_shapes.h"

#include <functional>
#include <map>
#include <umov/core/quantity.h>
#include <umov/shape/primitives.h>

namespace umov::cli {
namespace {

constexpr const char *rough_surface = "rough-surface";

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

} // namespace

std::vector<std::string> shape_names() {
  std::vector<std::string> out;
  for (const auto &[name, maker] : makers())
    out.push_back(name);
  out.emplace_back(rough_surface);
  return out;
}

Result<Mesh> make_shape(const ShapeOptions &options) {
  if (options.shape != rough_surface)
    return makers().at(options.shape)(options);
  UMOV_ASSIGN(field, make_height_field(options.rough));
  return mesh_of(field);
}

} // namespace umov::cli
