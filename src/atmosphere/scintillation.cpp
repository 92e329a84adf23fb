#include <umov/atmosphere/scintillation.h>

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

constexpr double wind_m_s = 20;

/// Osborn's law, of exposures that are long.
double long_variance(const ScintillationSite &site, double aperture_m, double exposure_s,
                     double airmass) {
  return 1e-5 * site.c_y * site.c_y * std::pow(aperture_m, -4. / 3) / exposure_s * airmass *
         airmass * airmass * std::exp(-2 * site.height_m / 8000);
}

} // namespace

double wind_crossing_s(double aperture_m) {
  // Of Kolmogorov's turbulence behind a round pupil, 10.64537/17.33207 before they were rounded.
  constexpr double of_diameter = 0.61420054;
  return of_diameter * aperture_m / wind_m_s;
}

double scintillation_sd(const ScintillationSite &site, double aperture_m, double exposure_s,
                        double airmass) {
  return slewing_scintillation_sd(site, aperture_m, exposure_s, airmass, 0);
}

double slewing_variance_factor(double rate_rad_s, double airmass) {
  constexpr double layer_m = 10e3;
  return wind_m_s / std::hypot(wind_m_s, rate_rad_s * layer_m * airmass);
}

double slewing_scintillation_sd(const ScintillationSite &site, double aperture_m, double exposure_s,
                                double airmass, double rate_rad_s) {
  const double shortest = long_variance(site, aperture_m, wind_crossing_s(aperture_m), airmass);
  const double taken = long_variance(site, aperture_m, exposure_s, airmass) *
                       slewing_variance_factor(rate_rad_s, airmass);
  return std::sqrt(std::min(taken, shortest));
}

} // namespace umov
