#include <umov/photometry/refracted_shadow.h>

#include <algorithm>
#include <cmath>
#include <umov/photometry/radiometry.h>

namespace umov {
namespace {

constexpr double scale_height_km = 8.0;
/// A ray that grazes the ground is bent twice by the horizon's refraction of 34.5 arcmin.
constexpr double bending_rad = 2 * 34.5 / 60 * pi / 180;

/// Rayleigh's extinction at the zenith [mag] from sea level: 0.0095 (1 um / wavelength)^4, and a
/// little more in the blue (Hayes & Latham 1975, Eq. 3 without its slow factor of the index).
double zenith_extinction(Wavelength wavelength) {
  const double um = wavelength.nm() / 1000;
  return 0.0094977 / (um * um * um * um) * (1 + 0.0113 / (um * um));
}

} // namespace

double refracted_sunlight(Angle sun_radius, double limb_radius_km, double distance_km,
                          Angle sun_from_nadir, Wavelength wavelength) {
  const double a = sun_radius.radians(), c = sun_from_nadir.radians();
  const double b = std::asin(std::min(1.0, limb_radius_km / distance_km));
  if (c > b + a + 0.02) // 0.02 rad above the limb is far above the air, whatever the orbit
    return 1;
  const double reach =
      std::sqrt(std::max(0.0, distance_km * distance_km - limb_radius_km * limb_radius_km));
  const double limb_airmass = 2 * airmass(Angle::radians(0)); // down to the ground and out again
  const double dim = 0.4 * std::log(10.0) * zenith_extinction(wavelength) * limb_airmass;
  // Apparent heights above the limb: fine within the air, then out to the top of the disk.
  const double air = 100 / reach, top = std::max(air, c + a - b);
  constexpr int steps = 4000;
  double sum = 0, before = 0, last = 0;
  for (int k = 0; k <= steps; ++k) {
    const double x = static_cast<double>(k) / steps;
    const double height = top * x * x * x; // denser near the ground
    const double air_share = std::exp(-height * reach / scale_height_km);
    const double place = b + height - bending_rad * air_share - c; // on the Sun, from its centre
    const double chord = std::abs(place) < a ? 2 * std::sqrt(a * a - place * place) : 0;
    const double value = chord * std::exp(-dim * air_share);
    if (k > 0)
      sum += 0.5 * (value + before) * (height - last);
    before = value;
    last = height;
  }
  return std::min(1.0, sum / (pi * a * a));
}

} // namespace umov
