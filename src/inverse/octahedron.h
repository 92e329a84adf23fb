#pragma once
// Private: an even grid of directions.

#include <algorithm>
#include <cmath>
#include <umov/core/rotation.h>
#include <utility>

namespace umov::inverse {

/// The direction of a point of the square [-1, 1]^2 that an octahedron is unfolded onto (Cigolle et
/// al. 2014, JCGT 3(2), "A Survey of Efficient Representations for Independent Unit Vectors").
inline Vec3<Body> direction_at(double x, double y) {
  const double z = 1 - std::abs(x) - std::abs(y);
  Vec3<Body> out{x, y, z};
  if (z < 0) {
    out.x = (1 - std::abs(y)) * (x >= 0 ? 1 : -1);
    out.y = (1 - std::abs(x)) * (y >= 0 ? 1 : -1);
  }
  return normalized(out);
}

/// And back.
inline std::pair<double, double> square_of(Vec3<Body> v) {
  const double sum = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
  const double x = v.x / sum, y = v.y / sum;
  if (v.z >= 0)
    return {x, y};
  return {(1 - std::abs(y)) * (x >= 0 ? 1 : -1), (1 - std::abs(x)) * (y >= 0 ? 1 : -1)};
}

/// (cells + 1)^2 directions, row by row.
struct DirectionGrid {
  std::size_t cells = 0;

  /// The four about a direction, with their weights.
  struct Corner {
    std::size_t node[4];
    float weight[4];
  };

  [[nodiscard]] std::size_t nodes() const { return (cells + 1) * (cells + 1); }
  [[nodiscard]] Vec3<Body> direction(std::size_t node) const {
    const auto at = [this](std::size_t step) {
      return 2 * static_cast<double>(step) / static_cast<double>(cells) - 1;
    };
    return direction_at(at(node % (cells + 1)), at(node / (cells + 1)));
  }
  [[nodiscard]] std::size_t nearest(Vec3<Body> direction) const {
    const auto [x, y] = square_of(direction);
    const auto n = static_cast<double>(cells);
    const auto i = static_cast<std::size_t>(std::lround(std::clamp((x + 1) / 2 * n, 0.0, n)));
    const auto j = static_cast<std::size_t>(std::lround(std::clamp((y + 1) / 2 * n, 0.0, n)));
    return j * (cells + 1) + i;
  }
  [[nodiscard]] Corner corner(Vec3<Body> direction) const {
    const auto [x, y] = square_of(direction);
    const auto n = static_cast<double>(cells);
    const double a = std::clamp((x + 1) / 2 * n, 0.0, n), b = std::clamp((y + 1) / 2 * n, 0.0, n);
    const double i = std::min(std::floor(a), n - 1), j = std::min(std::floor(b), n - 1);
    const auto fx = static_cast<float>(a - i), fy = static_cast<float>(b - j);
    const std::size_t row = cells + 1;
    const std::size_t node = static_cast<std::size_t>(j) * row + static_cast<std::size_t>(i);
    return {{node, node + 1, node + row, node + row + 1},
            {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
  }
};

/// Number of a pair of nodes, whichever of the two is the Sun's (reciprocity).
inline std::size_t pair_of(std::size_t a, std::size_t b, std::size_t nodes) {
  const std::size_t low = std::min(a, b), high = std::max(a, b);
  return low * nodes - low * (low + 1) / 2 + high;
}

} // namespace umov::inverse
