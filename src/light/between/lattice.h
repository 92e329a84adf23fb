#pragma once
#include <array>
#include <cmath>
#include <umov/core/random.h>

namespace umov {

/// Kronecker's sequence with the powers of the root of x^7 = x + 1 (Roberts 2018), shifted.
inline constexpr std::size_t dimensions = 6;
class Lattice {
public:
  Lattice(std::uint64_t seed, std::size_t replicate) {
    for (std::size_t d = 0; d < dimensions; d += 2) {
      const auto u = uniform4(seed, 0xB0C, replicate * dimensions + d);
      shift_[d] = u[0];
      shift_[d + 1] = u[1];
    }
  }
  [[nodiscard]] std::array<double, dimensions> at(std::size_t index) const {
    constexpr double root = 1.1127756842787055; // of x^7 = x + 1
    std::array<double, dimensions> out{};
    double power = 1;
    for (std::size_t d = 0; d < dimensions; ++d) {
      power /= root;
      const double x = shift_[d] + power * static_cast<double>(index);
      out[d] = x - std::floor(x);
    }
    return out;
  }

private:
  std::array<double, dimensions> shift_{};
};

} // namespace umov
