#pragma once
// Sunlight that the Earth sends to an object and the object to the observer.

#include <functional>
#include <umov/attitude/attitude.h>
#include <umov/light/integrator.h>
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

/// Irradiance of moonlight at an object per unit solar irradiance: 10^(-0.4 (V + 26.74)) with
/// V = -12.73 + 0.026 a + 4e-9 a^4 for a phase angle of a degrees at 384,400 km (Krisciunas &
/// Schaefer 1991, Eq. 20), grey in all bands; 0 beyond 160 deg and behind the Earth.
double moon_irradiance(const ObservingGeometry &geometry, Vec3<Gcrs> moon_km);

/// The same as `earth_light` for moonlight: one source, unpolarized (the Moon's own 0 to 10 % is
/// left out).
std::vector<Stokes<SkyNorth>> moon_light(const ObservingGeometry &geometry,
                                         const Rotation<Body, Gcrs> &body_from_gcrs,
                                         Vec3<Gcrs> sky_north, std::size_t bands,
                                         const LightOfPoses &light);

} // namespace umov
