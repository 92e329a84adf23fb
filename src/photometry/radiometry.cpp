#include <cmath>
#include <limits>
#include <umov/core/constants.h>
#include <umov/photometry/radiometry.h>

namespace umov {

double irradiance_at_observer(double intensity, double solar_irradiance, double sun_distance_km,
                              double sunlit, double range_km) {
  const double au = constants::au_km / sun_distance_km;
  const double range_m = range_km * 1000;
  return solar_irradiance * au * au * sunlit * intensity / (range_m * range_m);
}

double ab_magnitude(double irradiance, Wavelength wavelength) {
  if (!(irradiance > 0))
    return std::numeric_limits<double>::quiet_NaN();
  constexpr double zero_point = 3631e-26; // W m-2 Hz-1, Oke & Gunn 1983
  const double lambda = wavelength.metres();
  const double per_metre = irradiance * 1e9;
  const double f_nu = per_metre * lambda * lambda / (constants::speed_of_light_km_s * 1000);
  return -2.5 * std::log10(f_nu / zero_point);
}

Result<std::vector<PhotometricBand>> photometric_bands(const std::vector<Band> &bands,
                                                       MagnitudeSystem system) {
  std::vector<PhotometricBand> out;
  for (const Band &band : bands) {
    UMOV_ASSIGN(solar, solar_irradiance(band));
    UMOV_ASSIGN(zero, zero_irradiance(band, system));
    out.push_back({band, system, solar, zero});
  }
  return out;
}

double magnitude_of(double irradiance, const PhotometricBand &band) {
  if (!band.band.curve && band.system == MagnitudeSystem::AB)
    return ab_magnitude(irradiance, band.band.wavelength);
  return irradiance > 0 ? -2.5 * std::log10(irradiance / band.zero)
                        : std::numeric_limits<double>::quiet_NaN();
}

ObservedLight observed_light(double intensity, const PhotometricBand &band, const LightPath &path) {
  const double irradiance = irradiance_at_observer(intensity, band.solar, path.sun_distance_km,
                                                   path.sunlit, path.range_km);
  return {irradiance, magnitude_of(irradiance, band)};
}

double airmass(Angle altitude) {
  const double h = altitude.degrees();
  if (h < 0)
    return std::numeric_limits<double>::quiet_NaN();
  return 1 / (std::sin(altitude.radians()) + 0.50572 * std::pow(h + 6.07995, -1.6364));
}

} // namespace umov
