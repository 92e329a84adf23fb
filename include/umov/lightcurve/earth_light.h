#pragma once
// Sunlight that the Earth sends to an object and the object to the observer.

#include <functional>
#include <umov/attitude/attitude.h>
#include <umov/lightcurve/integrator.h>
#include <umov/optics/stokes.h>
#include <umov/orbit/ephemeris.h>

namespace umov {

/// A Lambert Earth of one albedo.
struct EarthshineOptions {
  double albedo = 0.3;
  std::size_t patches = 200; ///< of the cap that the object sees, each a source of its own
};

/// Light of many directions at once: per pose and band, in its own scattering plane.
using LightOfPoses =
    std::function<std::vector<std::vector<BandResult>>(const std::vector<Pose> &poses)>;

/// Intensity per unit solar irradiance [m2/sr] by earthshine, per band, in sky axes (equatorial, or
/// the site's zenith if `is_altaz`). Each lit patch of equal solid angle is a source of irradiance
/// albedo/pi times the Sun's cosine there times its solid angle, with a scattering plane of its
/// own that is turned into the sky's axes before the sum (physics: docs/theory/earthshine.md). The
/// Earth is a sphere of 6378.137 km.
std::vector<Stokes<SkyNorth>> earth_light(const ObservingGeometry &geometry,
                                          const Rotation<Body, Gcrs> &body_from_gcrs,
                                          Vec3<Gcrs> sky_north, const EarthshineOptions &options,
                                          std::size_t bands, const LightOfPoses &light);

} // namespace umov
