#include <umov/photometry/passband.h>

#include <algorithm>
#include <cmath>
#include <umov/optics/band.h>

namespace umov {

Result<std::vector<double>> sunlight_weights(const Passband &band) {
  const auto &at = band.wavelength_nm;
  std::vector<double> out(at.size());
  double sum = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double step = (at[std::min(i + 1, at.size() - 1)] - at[i > 0 ? i - 1 : 0]) / 2;
    UMOV_ASSIGN(sun, solar_irradiance(Wavelength::nm(at[i])));
    out[i] = band.response[i] * sun * at[i] * step;
    sum += out[i];
  }
  for (double &w : out)
    w /= sum;
  return out;
}

double mean_wavelength_nm(const Passband &band, const std::vector<double> &weights) {
  double out = 0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    out += weights[i] * band.wavelength_nm[i];
  return out;
}

double clear_extinction_mag(double wavelength_nm, double pressure_hpa, double aerosol_550) {
  const double um = wavelength_nm / 1000, w2 = 1 / (um * um);
  const double molecules =
      0.008569 * w2 * w2 * (1 + 0.0113 * w2 + 0.00013 * w2 * w2) * pressure_hpa / 1013.25;
  const double aerosol = aerosol_550 * std::pow(wavelength_nm / 550, -1.3);
  return 2.5 / std::log(10.) * (molecules + aerosol);
}

} // namespace umov
