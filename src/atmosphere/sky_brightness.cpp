#include <umov/atmosphere/sky_brightness.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

namespace umov {
namespace {

/// What is known of a band of the sky.
struct SkyRow {
  double nm;            ///< where it lies (Bessell 1990)
  double dark;          ///< mag / arcsec^2
  double fit[3];        ///< twilight: powers of zenith distance - 95 deg
  double ab_minus_vega; ///< Sun, AB minus Vega
};

constexpr SkyRow rows[] = {
    {360, 22.3, {11.78, 1.376, -.039}, .7287},  {440, 22.6, {11.84, 1.411, -.041}, -.1294},
    {550, 21.6, {11.84, 1.518, -.057}, -.0087}, {656, 20.9, {11.40, 1.567, -.064}, .1845},
    {805, 19.7, {10.93, 1.470, -.062}, .4110},
};

const SkyRow &row(SkyBand band) { return rows[static_cast<std::size_t>(band)]; }

/// Air mass of a glowing layer (Krisciunas & Schaefer 1991, Eq. 3).
double layer_airmass(Angle zenith_distance) {
  const double s = std::sin(zenith_distance.radians());
  return 1 / std::sqrt(1 - 0.96 * s * s);
}

} // namespace

SkyBand nearest_sky_band(double nm) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < std::size(rows); ++k)
    if (std::abs(rows[k].nm - nm) < std::abs(rows[best].nm - nm))
      best = k;
  return static_cast<SkyBand>(best);
}

double ab_minus_vega(SkyBand band) { return row(band).ab_minus_vega; }

double dark_sky_mag(SkyBand band) { return row(band).dark; }

double twilight_mag(SkyBand band, Angle sun_zenith_distance) {
  const double x = sun_zenith_distance.degrees() - 95;
  const auto &a = row(band).fit;
  return a[0] + a[1] * x + a[2] * x * x;
}

double night_sky_mag(SkyBand band, Angle sun_altitude, double dark_mag) {
  constexpr double first = 95, last = 105; // of the fit [deg]
  const double distance = 90 - sun_altitude.degrees();
  if (distance < first)
    return std::numeric_limits<double>::quiet_NaN();
  if (distance > last)
    return dark_mag;
  return std::min(dark_mag, twilight_mag(band, Angle::degrees(distance)));
}

double nanolamberts(double v_mag) { return 34.08 * std::exp(20.7233 - 0.92104 * v_mag); }

double v_mag_of_nanolamberts(double nl) { return (20.7233 - std::log(nl / 34.08)) / 0.92104; }

double moonlight_nl(const MoonOnSky &moon, Angle zenith_distance, double extinction_mag) {
  if (moon.zenith_distance.degrees() >= 90)
    return 0;
  const double a = std::abs(moon.phase.degrees()), r = moon.separation.degrees();
  const double light = std::pow(10, -0.4 * (3.84 + 0.026 * a + 4e-9 * a * a * a * a));
  const double c = std::cos(moon.separation.radians());
  const double scattered = std::pow(10, 5.36) * (1.06 + c * c) + std::pow(10, 6.15 - r / 40);
  const double in = std::pow(10, -0.4 * extinction_mag * layer_airmass(moon.zenith_distance));
  const double out = 1 - std::pow(10, -0.4 * extinction_mag * layer_airmass(zenith_distance));
  return scattered * light * in * out;
}

} // namespace umov
