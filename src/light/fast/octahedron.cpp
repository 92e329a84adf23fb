#include "light/fast/octahedron.h"

#include <algorithm>
#include <cmath>

namespace umov {
SquarePoint octahedron_point(Vec3<Body> d) { return backend::octahedron_point(d); }

Vec3<Body> octahedron_direction(SquarePoint p) {
  double x = 2 * p.u - 1, y = 2 * p.v - 1;
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z < 0)
    backend::fold_square(x, y);
  return normalized(Vec3<Body>{x, y, z});
}

Vec3<Body> grid_direction(std::size_t cells, std::size_t index) {
  const double n = static_cast<double>(cells);
  return octahedron_direction(
      {static_cast<double>(index / (cells + 1)) / n, static_cast<double>(index % (cells + 1)) / n});
}

backend::GridLook look_around(std::size_t cells, Vec3<Body> direction) {
  return backend::look_around(cells, direction);
}

double grid_reach(std::size_t cells) {
  // A cell's diagonal is 2 sqrt(2) / cells on the octahedron, seen from its centre at the least
  // distance 1/sqrt(3).
  return std::min(1.0, 2 * std::sqrt(6.0) / static_cast<double>(cells));
}

std::uint32_t curve_order(Vec3<Body> direction) {
  const SquarePoint p = octahedron_point(direction);
  const auto u = static_cast<std::uint32_t>(std::clamp(p.u, 0.0, 1.0) * 4095);
  const auto v = static_cast<std::uint32_t>(std::clamp(p.v, 0.0, 1.0) * 4095);
  std::uint32_t out = 0;
  for (unsigned bit = 0; bit < 12; ++bit)
    out |= ((u >> bit) & 1u) << (2 * bit) | ((v >> bit) & 1u) << (2 * bit + 1);
  return out;
}

} // namespace umov
