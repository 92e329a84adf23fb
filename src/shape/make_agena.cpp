// Agena D from published overall dimensions; data/mesh/README.md has the source of each.

#include <umov/shape/primitives.h>

#include "shape/mesh_builder.h"

namespace umov {

Mesh make_agena(const AgenaOptions &options) {
  MeshBuilder builder;
  const std::uint32_t nozzle = builder.group("nozzle_titanium"),
                      rack = builder.group("rack_aluminium"),
                      tank = builder.group("tank_aluminium"), white = builder.group("paint_white"),
                      black = builder.group("paint_black"), cap = builder.group("cap_gold_kapton");
  constexpr double radius = 1.52 / 2;
  // The nozzle is closed by a disk at its exit; the aft rack tapers to the engine.
  const std::vector<Outline> outline{{0, 0},         {0, 0.42},      {0.5, 0.33},    {0.95, 0.14},
                                     {0.95, 0.5},    {1.35, radius}, {1.95, radius}, {4.95, radius},
                                     {6.25, radius}, {6.75, 0.55},   {7.09, 0.2},    {7.09, 0}};
  const std::vector<std::uint32_t> groups{nozzle, nozzle, nozzle, rack, rack, rack,
                                          tank,   white,  cap,    cap,  cap};
  constexpr std::size_t striped = 7, stripes = 8;
  builder.revolve(outline, options.sides, {}, [&](std::size_t segment, std::size_t side) {
    if (segment != striped)
      return groups[segment];
    return side * stripes / options.sides % 2 == 0 ? white : black;
  });
  return builder.mesh;
}

} // namespace umov
