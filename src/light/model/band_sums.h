#pragma once
// Private: from light at wavelengths to light in bands.

#include <umov/light/stokes_table.h>
#include <umov/optics/band_grid.h>

namespace umov {

/// Makes room in `out` for the bands of as many poses, with the optional columns of `nodes`.
void size_as(const StokesTable &nodes, const BandGrid &grid, std::size_t poses,
             std::size_t materials, StokesTable &out);

/// Sums the wavelengths of each band, rows of `nodes` into rows of `out` from `begin` on. Light at
/// neighbouring wavelengths comes from the same points and paths, so that its half-widths add up.
void sum_bands(const StokesTable &nodes, const BandGrid &grid, std::size_t materials,
               std::size_t begin, unsigned threads, StokesTable &out);

} // namespace umov
