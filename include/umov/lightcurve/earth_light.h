#pragma once
// Sunlight that the Earth sends to an object and the object to the observer.

#include <functional>
#include <umov/attitude/attitude.h>
#include <umov/light/integrator.h>
#include <umov/optics/stokes.h>
#include <umov/orbit/ephemeris.h>
#include <umov/scene/scene.h>

namespace umov {

/// A Lambert Earth of one albedo.
struct EarthshineOptions {
  double albedo = 0.3;
  /// Of the cap that the object sees, each a source of its own, to begin with: where they do not
  /// resolve a lobe they are cut, up to `patches_bound` times as many in all.
  std::size_t patches = 200;
  double accuracy = 0.02; ///< wanted relative 95 % half-width of I
  /// Slope of the narrowest lobe that is lit, 0 for a mirror: patches begin so small that none can
  /// fall between them.
  double narrowest_lobe = 1;
};
/// Slope of the narrowest lobe of a scene's surfaces.
double narrowest_lobe(const Scene &scene);
inline constexpr std::size_t patches_bound = 100;

/// Light by another source than the Sun, per band, [m2/sr] per unit solar irradiance.
struct SourceLight {
  std::vector<Stokes<SkyNorth>> stokes;
  std::vector<Stokes<SkyNorth>> half_width; ///< numerical 95 % half-widths of I, Q, U, V
  std::size_t sources = 0;                  ///< directions that were asked for
};

/// Light of many directions at once: per pose and band, in its own scattering plane.
using LightOfPoses =
    std::function<std::vector<std::vector<BandResult>>(const std::vector<Pose> &poses)>;

/// Light by earthshine in the axes of `sky_north`. Each lit patch is a source of irradiance
/// albedo/pi times the Sun's cosine there times its solid angle, as wide as itself, with a
/// scattering plane of its own that is turned into the sky's axes before the sum. Patches are cut
/// into four, whole generations at a time, until what that changes is below `accuracy` of I
/// (physics: docs/theory/earthshine.md). The Earth is a sphere of 6378.137 km.
SourceLight earth_light(const ObservingGeometry &geometry,
                        const Rotation<Body, Gcrs> &body_from_gcrs, Vec3<Gcrs> sky_north,
                        const EarthshineOptions &options, std::size_t bands,
                        const LightOfPoses &light);

/// Irradiance of moonlight at an object per unit solar irradiance: 10^(-0.4 (V + 26.74)) with
/// V = -12.73 + 0.026 a + 4e-9 a^4 for a phase angle of a degrees at 384,400 km (Krisciunas &
/// Schaefer 1991, Eq. 20), grey in all bands; 0 beyond 160 deg and behind the Earth.
double moon_irradiance(const ObservingGeometry &geometry, Vec3<Gcrs> moon_km);

/// The same as `earth_light` for moonlight: one source, unpolarized (the Moon's own 0 to 10 % is
/// left out).
SourceLight moon_light(const ObservingGeometry &geometry,
                       const Rotation<Body, Gcrs> &body_from_gcrs, Vec3<Gcrs> sky_north,
                       std::size_t bands, const LightOfPoses &light);

} // namespace umov
