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
/// What the light of the sky depends on, beside the place.
struct SkyModel {
  SkyOptions options;
  Air air;
  BandResponse v; ///< Bessell's V
};
/// Dark sky, twilight and moonlight, each with its polarization. Moonlight is known in V: in other
/// bands it is sunlight as bright there, scattered by as much as the air takes away in the band
/// (the course of Noll et al. 2012 and Jones et al. 2013). That the Moon is redder than the Sun,
/// and that its light is scattered more than once, is left out.
SkyLight sky_light(const SkyModel &sky, const BandResponse &band,
                   const ObservingGeometry &geometry);

} // namespace umov::jobs
