#pragma once
// Surface brightness of the night sky, in mag / arcsec^2 of the Vega system unless said.

#include <umov/core/quantity.h>

namespace umov {

/// Bands in which the sky was measured.
enum class SkyBand { U, B, V, R, I };

/// The one whose wavelength is nearest.
SkyBand nearest_sky_band(double nm);
/// Magnitude of the AB system minus that of the Vega system, from the Sun in both (docs/theory).
double ab_minus_vega(SkyBand band);

/// Moonless zenith (Patat 2003, A&A 400, 1183).
double dark_sky_mag(SkyBand band);

/// Zenith in twilight (Patat, Ugolnikov & Postylyakov 2006, A&A 455, 385, table of fits): Sun 95 to
/// 105 deg from the zenith. The fit holds the night's level and turns over beyond it: after 105 deg
/// use `night_sky_mag`. Scatter .1 to .4 mag.
double twilight_mag(SkyBand band, Angle sun_zenith_distance);

/// Dark sky and twilight: the fit up to 105 deg, never fainter than `dark_mag`; beyond it the dark
/// sky. NaN above an altitude of the Sun of -5 deg, where nothing was fitted.
double night_sky_mag(SkyBand band, Angle sun_altitude, double dark_mag);

/// Where the Moon stands, for its light on the sky.
struct MoonOnSky {
  Angle phase;           ///< Sun-Moon-Earth, 0 = full
  Angle separation;      ///< of the Moon and the place; the model holds beyond 10 deg
  Angle zenith_distance; ///< of the Moon
};

/// Moonlight in V [nanolamberts] (Krisciunas & Schaefer 1991, PASP 103, 1033, Eqs. 3, 15, 20, 21),
/// good to about a fifth. 0 with the Moon below the horizon.
double moonlight_nl(const MoonOnSky &moon, Angle zenith_distance, double extinction_mag);
/// Their Eq. 1: nanolamberts of a V surface brightness.
double nanolamberts(double v_mag);
/// And back.
double v_mag_of_nanolamberts(double nl);

} // namespace umov
