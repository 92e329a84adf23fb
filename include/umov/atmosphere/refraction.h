#pragma once
#include <umov/core/quantity.h>

namespace umov {

/// Air at the telescope, as far as it bends light.
struct SurfaceAir {
  double pressure_hpa = 1013.25;
  double temperature_k = 283.15;
  double water_hpa = 4; ///< partial pressure of water vapour
};

/// Refractive index of air minus one (Filippenko 1982, PASP 94, 715, Eqs. 1-3).
double air_refractivity(double nm, const SurfaceAir &air);

/// Refraction of a source at a true (airless) altitude, >= 0: (n^2 - 1)/(2 n^2) tan z down to 15
/// deg; below it the same law in proportion to Saemundsson's curve (1986, Sky & Telescope 72, 70),
/// which stays finite at the horizon and is good to a few arc seconds above 5 deg.
Angle refraction(double nm, Angle true_altitude, const SurfaceAir &air);

/// Altitude at which the source is seen.
Angle apparent_altitude(double nm, Angle true_altitude, const SurfaceAir &air);

} // namespace umov
