#pragma once
// Explicit rough surfaces: random height fields, to hold statistical models against.

#include <cstdint>
#include <umov/core/result.h>
#include <umov/shape/mesh.h>
#include <vector>

namespace umov {

/// A random rough surface: its size and statistics.
struct RoughSurfaceOptions {
  std::size_t cells = 256;      ///< per side, each two triangles (256: 131,072)
  double cell_m = 1;            ///< side of a cell
  double slope = 0.3;           ///< rms slope along each axis; Beckmann's alpha is sqrt(2) times it
  double correlation_cells = 8; ///< correlation length (autocorrelation exp(-r2/l2)), in cells
  double hurst = 0;             ///< 0: one scale; else octaves down to two cells, heights ~ scale^H
  std::uint64_t seed = 0;
};

/// Heights [m] on a periodic grid, row by row; mean 0, rms slope of the facets as asked.
struct HeightField {
  std::size_t cells = 0;
  double cell_m = 1;
  std::vector<double> height_m;
  /// Height of a grid point; the surface repeats itself.
  [[nodiscard]] double at(std::size_t x, std::size_t y) const { // periodic
    return height_m[(y % cells) * cells + x % cells];
  }
  /// Length of a side.
  [[nodiscard]] double side_m() const { return static_cast<double>(cells) * cell_m; }
};

/// A Gaussian random field by filtered noise. BadInput for less than 16 or more than 2048 cells, a
/// slope outside 0..3, a correlation length below 2 cells or above an eighth of the side, a Hurst
/// exponent outside 0..1.
Result<HeightField> make_height_field(const RoughSurfaceOptions &options);
/// The field as an open sheet, corner at the origin, +z up, group "surface".
Mesh mesh_of(const HeightField &field);

} // namespace umov
