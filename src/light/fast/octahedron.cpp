#include "light/fast/octahedron.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

/// The lower half of the octahedron is folded over the corners of the square.
void fold(double &x, double &y) {
  const double folded_x = std::copysign(1 - std::abs(y), x);
  y = std::copysign(1 - std::abs(x), y);
  x = folded_x;
}

} // namespace

SquarePoint octahedron_point(Vec3<Body> d) {
  const double scale = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  double x = d.x * scale, y = d.y * scale;
  if (d.z < 0)
    fold(x, y);
  return {0.5 * (x + 1), 0.5 * (y + 1)};
}

Vec3<Body> octahedron_direction(SquarePoint p) {
  double x = 2 * p.u - 1, y = 2 * p.v - 1;
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z < 0)
    fold(x, y);
  return normalized(Vec3<Body>{x, y, z});
}

Vec3<Body> grid_direction(std::size_t cells, std::size_t index) {
  const double n = static_cast<double>(cells);
  return octahedron_direction(
      {static_cast<double>(index / (cells + 1)) / n, static_cast<double>(index % (cells + 1)) / n});
}

backend::GridLook look_around(std::size_t cells, Vec3<Body> direction) {
  const SquarePoint p = octahedron_point(direction);
  const double n = static_cast<double>(cells);
  const auto cell_of = [&](double x) {
    return std::min(static_cast<std::size_t>(std::max(x * n, 0.0)), cells - 1);
  };
  const std::size_t i = cell_of(p.u), j = cell_of(p.v);
  const double a = p.u * n - static_cast<double>(i), b = p.v * n - static_cast<double>(j);
  const auto corner = [&](std::size_t di, std::size_t dj) {
    return static_cast<std::uint32_t>((i + di) * (cells + 1) + j + dj);
  };
  backend::GridLook out;
  const auto set = [&](std::size_t k, std::uint32_t direction_index, double weight) {
    out.direction[k] = direction_index;
    out.weight[k] = static_cast<float>(std::max(weight, 0.0));
  };
  // The octahedron's slanted edges run across the diagonal in two quarters of the square and along
  // it in the other two.
  if ((2 * i < cells) == (2 * j < cells)) {
    set(0, corner(1, 0), a + b < 1 ? a : 1 - b);
    set(1, corner(0, 1), a + b < 1 ? b : 1 - a);
    if (a + b < 1)
      set(2, corner(0, 0), 1 - a - b);
    else
      set(2, corner(1, 1), a + b - 1);
  } else {
    set(0, corner(0, 0), a > b ? 1 - a : 1 - b);
    set(1, corner(1, 1), a > b ? b : a);
    if (a > b)
      set(2, corner(1, 0), a - b);
    else
      set(2, corner(0, 1), b - a);
  }
  return out;
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
