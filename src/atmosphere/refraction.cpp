#include <umov/atmosphere/refraction.h>

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

/// Saemundsson's refraction of a true altitude [deg], in minutes of arc at 1010 hPa and 283 K.
double saemundsson(double altitude_deg) {
  const double at = altitude_deg + 10.3 / (altitude_deg + 5.11);
  return 1.02 / std::tan(at * pi / 180);
}

} // namespace

double air_refractivity(double nm, const SurfaceAir &air) {
  constexpr double mm_hg = 0.750061683; // per hPa
  const double p = air.pressure_hpa * mm_hg, w = air.water_hpa * mm_hg;
  const double t = air.temperature_k - 273.15, s2 = 1e6 / (nm * nm); // 1/um^2
  const double standard = 64.328 + 29498.1 / (146 - s2) + 255.4 / (41 - s2);
  const double dry =
      standard * p * (1 + (1.049 - 0.0157 * t) * 1e-6 * p) / (720.883 * (1 + 0.003661 * t));
  const double wet = (0.0624 - 0.000680 * s2) / (1 + 0.003661 * t) * w;
  return (dry - wet) * 1e-6;
}

Angle refraction(double nm, Angle true_altitude, const SurfaceAir &air) {
  const double n = air_refractivity(nm, air); // minus one
  const double constant = n * (n + 2) / (2 * (n + 1) * (n + 1));
  constexpr double lowest = 15; // [deg] of the plane-parallel law
  const double altitude = std::max(0.0, true_altitude.degrees());
  if (altitude >= lowest)
    return Angle::radians(constant / std::tan(altitude * pi / 180));
  return Angle::radians(constant / std::tan(lowest * pi / 180) * saemundsson(altitude) /
                        saemundsson(lowest));
}

Angle apparent_altitude(double nm, Angle true_altitude, const SurfaceAir &air) {
  return Angle::radians(true_altitude.radians() + refraction(nm, true_altitude, air).radians());
}

} // namespace umov
