#include <umov/instrument/mosaic.h>

#include <cmath>
#include <umov/core/quantity.h>

namespace umov {

double mosaic_alias_strength(double fwhm_px) {
  const double sigma = fwhm_px / std::sqrt(8 * std::log(2.));
  return 4 / pi * std::exp(-pi * pi * sigma * sigma / 2);
}

MosaicAlias mosaic_alias(double fwhm_px, double x_px, double y_px) {
  const double e = mosaic_alias_strength(fwhm_px);
  const double cx = std::cos(pi * x_px), cy = std::cos(pi * y_px);
  return {-e * (cx + cy) / (1 + e * e * cx * cy), e * (cy - cx) / (1 - e * e * cx * cy)};
}

double drift_factor(double length_px) {
  const double x = pi * length_px / 2;
  return x == 0 ? 1 : std::abs(std::sin(x) / x);
}

} // namespace umov
