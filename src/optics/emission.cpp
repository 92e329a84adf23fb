#include <umov/optics/emission.h>

#include <cmath>

namespace umov {

Emissivity smooth_emissivity(const Interface &surface, double cos_emission) {
  const MuellerEntries r = surface.reflection(cos_emission);
  return {1 - r.a, -r.b};
}

double planck_radiance(Wavelength wavelength, double temperature_k) {
  constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23; // exact in the SI of 2019
  if (!(temperature_k > 0))
    return 0;
  const double m = wavelength.metres();
  const double per_metre =
      2 * h * c * c / (m * m * m * m * m) / std::expm1(h * c / (m * k * temperature_k));
  return per_metre * 1e-9;
}

} // namespace umov
