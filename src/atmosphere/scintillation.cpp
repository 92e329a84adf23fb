#include <umov/atmosphere/scintillation.h>

#include <cmath>

namespace umov {

double scintillation_sd(const ScintillationSite &site, double aperture_m, double exposure_s,
                        double airmass) {
  const double variance = 1e-5 * site.c_y * site.c_y * std::pow(aperture_m, -4. / 3) / exposure_s *
                          airmass * airmass * airmass * std::exp(-2 * site.height_m / 8000);
  return std::sqrt(variance);
}

double slewing_variance_factor(double rate_rad_s, double airmass) {
  constexpr double wind_m_s = 20, layer_m = 10e3;
  return wind_m_s / std::hypot(wind_m_s, rate_rad_s * layer_m * airmass);
}

} // namespace umov
