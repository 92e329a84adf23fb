#pragma once
// Directions on the unfolded octahedron (Meyer et al. 2010, "On
// floating-point normal vectors") and the grid over it, for every machine.

#include "backend/scene_data.h"
#include "kernel/math.inl.h"

namespace umov::backend {

/// Rounded before it is used. A card's compiler would join it with a sum behind it, and at the edge
/// of two triangles of the grid take another one than the processor has traced.
UMOV_KERNEL double rounded_product(double a, double b) {
#ifdef __CUDA_ARCH__
  return __dmul_rn(a, b);
#else
  return a * b;
#endif
}

/// Point of the unit square for a unit vector; continuous but for its folded border.
struct SquarePoint {
  double u, v;
};

/// The lower half of the octahedron is folded over the corners of the square.
UMOV_KERNEL void fold_square(double &x, double &y) {
  using kernel::abs;
  using std::copysign;
  const double folded_x = copysign(1 - abs(y), x);
  y = copysign(1 - abs(x), y);
  x = folded_x;
}

/// V is any vector with x, y and z.
template <class V> UMOV_KERNEL SquarePoint octahedron_point(const V &d) {
  using kernel::abs;
  const double scale = 1 / (abs(d.x) + abs(d.y) + abs(d.z));
  double x = rounded_product(d.x, scale), y = rounded_product(d.y, scale);
  if (d.z < 0)
    fold_square(x, y);
  return {0.5 * (x + 1), 0.5 * (y + 1)};
}

/// Cell of a coordinate of the square, in cells, of so many.
UMOV_KERNEL std::size_t cell_of(double x, std::size_t cells) {
  const auto cell = static_cast<std::size_t>(kernel::max(x, 0.0));
  return cell < cells ? cell : cells - 1;
}

/// The corners of the triangle of the grid of cells x cells that holds a direction, and barycentric
/// weights. Cells are cut along the octahedron's edges; `cells` must be even so that no cell
/// crosses one.
template <class V> UMOV_KERNEL GridLook look_around(std::size_t cells, const V &direction) {
  const SquarePoint p = octahedron_point(direction);
  const double n = static_cast<double>(cells);
  const double x = rounded_product(p.u, n), y = rounded_product(p.v, n);
  const std::size_t i = cell_of(x, cells), j = cell_of(y, cells);
  const double a = x - static_cast<double>(i), b = y - static_cast<double>(j);
  const auto corner = [&](std::size_t di, std::size_t dj) {
    return static_cast<std::uint32_t>((i + di) * (cells + 1) + j + dj);
  };
  GridLook out;
  const auto set = [&](std::size_t k, std::uint32_t direction_index, double weight) {
    out.direction[k] = direction_index;
    out.weight[k] = static_cast<float>(kernel::max(weight, 0.0));
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

} // namespace umov::backend
