#pragma once
// Private: light of the sky where an object stands.

#include <umov/io/observation.h>
#include <umov/orbit/ephemeris.h>

namespace umov::jobs {

/// Sky of one band at a time and place, in zenith axes.
struct SkyLight {
  Stokes<SkyNorth> per_arcsec2; ///< [W m-2 nm-1 arcsec-2]
  bool is_outside_fit = false;  ///< the Sun is too high for the model of twilight
};
/// Dark sky, twilight and moonlight, each with its polarization. `extinction`: of V [mag per air
/// mass].
SkyLight sky_light(const SkyOptions &options, const BandResponse &band,
                   const ObservingGeometry &geometry, double extinction);

} // namespace umov::jobs
