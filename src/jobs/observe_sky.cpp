#include "jobs/observe_sky.h"

#include <cmath>
#include <umov/atmosphere/sky_brightness.h>
#include <umov/atmosphere/sky_polarization.h>
#include <umov/orbit/moon.h>

namespace umov::jobs {
namespace {

/// Directions at the site with the zenith up; about the vertical any axes serve.
class Horizon {
public:
  explicit Horizon(const ObservingGeometry &g) : up_(g.zenith) {
    x_ = any_perpendicular(up_);
    y_ = cross(up_, x_);
  }
  [[nodiscard]] Vec3<Enu> direction(Vec3<Gcrs> v) const {
    const Vec3<Gcrs> u = normalized(v);
    return {dot(u, x_), dot(u, y_), dot(u, up_)};
  }

private:
  Vec3<Gcrs> up_, x_, y_;
};

Stokes<SkyNorth> polarized(double intensity, const SkyPolarization &p) {
  const double twice = 2 * p.axis.radians();
  return {intensity, intensity * p.degree * std::cos(twice), intensity * p.degree * std::sin(twice),
          0};
}

Angle from_zenith(Vec3<Enu> v) { return Angle::radians(std::acos(std::min(1.0, v.z))); }

Stokes<SkyNorth> moonlight(const SkyModel &sky, const BandResponse &band,
                           const ObservingGeometry &g, const Horizon &horizon, Vec3<Enu> to_sky) {
  const Vec3<Gcrs> moon = moon_km(g.time);
  const Vec3<Enu> to_moon = horizon.direction(moon - g.observer_gcrs_km);
  if (!sky.options.has_moon || to_moon.z <= 0)
    return {};
  MoonOnSky at;
  at.phase = Angle::radians(angle_between(-moon, g.sun_gcrs_km - moon));
  at.separation = Angle::radians(angle_between(to_moon, to_sky));
  at.zenith_distance = from_zenith(to_moon);
  const double nl = moonlight_nl(at, from_zenith(to_sky), extinction_mag(band.pivot_nm, sky.air));
  if (!(nl > 0))
    return {};
  const double v_mag = v_mag_of_nanolamberts(nl) + ab_minus_vega(SkyBand::V); // AB
  const double flux =
      sky.v.zero_flux * std::pow(10, -0.4 * v_mag) * band.solar_mean / sky.v.solar_mean;
  return polarized(flux, scattered_sky(to_moon, to_sky, sky.options.dilution_moon));
}

} // namespace

bool is_day(const SkyOptions &options, Angle sun_altitude) {
  return !options.mag && options.has_twilight &&
         std::isnan(night_sky_mag(SkyBand::V, sun_altitude, 0));
}

Stokes<SkyNorth> sky_light(const SkyModel &sky, const BandResponse &band,
                           const ObservingGeometry &g) {
  const SkyOptions &options = sky.options;
  const Horizon horizon(g);
  const Vec3<Enu> to_sky = horizon.direction(-g.to_observer);
  const Vec3<Enu> to_sun = horizon.direction(g.sun_gcrs_km - g.observer_gcrs_km);
  const SkyPolarization by_sun = scattered_sky(to_sun, to_sky, options.dilution_sun);
  if (options.mag) {
    const double flux = band.zero_flux * std::pow(10, -0.4 * *options.mag);
    return polarized(flux, {options.p, by_sun.axis});
  }
  const SkyBand letter = nearest_sky_band(band.pivot_nm);
  const auto own = options.dark_mag.find(std::string(1, "UBVRI"[static_cast<int>(letter)]));
  const double dark = own != options.dark_mag.end() ? own->second : dark_sky_mag(letter);
  // A magnitude of the Vega system as a flux in the band.
  const double to_flux = band.zero_flux * std::pow(10, -0.4 * ab_minus_vega(letter));
  const double night = options.has_twilight ? night_sky_mag(letter, g.sun_altitude, dark) : dark;
  const double base = to_flux * std::pow(10, -0.4 * dark);
  const double sunlit = to_flux * std::pow(10, -0.4 * night) - base;
  return Stokes<SkyNorth>{base, 0, 0, 0} + polarized(std::max(0.0, sunlit), by_sun) +
         moonlight(sky, band, g, horizon, to_sky);
}

} // namespace umov::jobs
