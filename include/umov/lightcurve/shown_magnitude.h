#pragma once
// The magnitude that a table shows of light with an error.

#include <umov/light/stokes_table.h>
#include <umov/photometry/radiometry.h>

namespace umov {

/// A magnitude as tables show it.
struct ShownMagnitude {
  double magnitude = 0;  ///< of the band's system; NaN in the dark
  bool is_limit = false; ///< the object is fainter
};

/// Of light whose I is three times its half-width, its own; of other light, that of I and
/// half-width together, a limit; in no case one beyond `faintest_magnitude`. Where nothing arrives
/// (`path` in the umbra, or I not positive): NaN, or in sunlight the limit.
ShownMagnitude shown_magnitude(const BandResult &light, const PhotometricBand &colour,
                               const LightPath &path);

} // namespace umov
