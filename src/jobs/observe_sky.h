#pragma once
// Private: light of the sky where an object stands.

#include <umov/io/observation.h>
#include <umov/orbit/ephemeris.h>

namespace umov::jobs {

/// What the light of the sky depends on, beside the place.
struct SkyModel {
  SkyOptions options;
  Air air;
  BandResponse v; ///< Bessell's V
};
/// The Sun stands too high for the model of twilight.
bool is_day(const SkyOptions &options, Angle sun_altitude);
/// Dark sky, twilight and moonlight, each with its polarization, in zenith axes [W m-2 nm-1
/// arcsec-2]; not by day. Moonlight is known in V: in other
/// bands it is sunlight as bright there, scattered by as much as the air takes away in the band
/// (assumed; Jones et al. 2013, A&A 560, A91, compute it). That the Moon is redder than the Sun,
/// and that its light is scattered more than once, is left out.
Stokes<SkyNorth> sky_light(const SkyModel &sky, const BandResponse &band,
                           const ObservingGeometry &geometry);

} // namespace umov::jobs
