#include <umov/instrument/mosaic.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <umov/core/quantity.h>
#include <umov/instrument/frame_photometry.h>
#include <umov/instrument/pixel_image.h>

namespace umov {

double mosaic_alias_strength(double fwhm_px) {
  const double sigma = fwhm_px / std::sqrt(8 * std::log(2.));
  return 4 / pi * std::exp(-pi * pi * sigma * sigma / 2);
}

namespace {

/// Light in even rows or columns less that in odd ones. The fifth harmonic of the lattice is below
/// 1e-10 of the light from a width of 1 px on.
double even_less_odd(double fwhm_px, double offset_px) {
  const double sigma = fwhm_px / std::sqrt(8 * std::log(2.));
  const double third = 4 / (3 * pi) * std::exp(-9 * pi * pi * sigma * sigma / 2);
  return mosaic_alias_strength(fwhm_px) * std::cos(pi * offset_px) -
         third * std::cos(3 * pi * offset_px);
}

} // namespace

MosaicAlias mosaic_alias(double fwhm_px, double x_px, double y_px) {
  const double x = even_less_odd(fwhm_px, x_px), y = even_less_odd(fwhm_px, y_px);
  return {-(x + y) / (1 + x * y), (y - x) / (1 - x * y)};
}

double drift_factor(double length_px) {
  const double x = pi * length_px / 2;
  return x == 0 ? 1 : std::abs(std::sin(x) / x);
}

double mosaic_aperture_alias(ImageProfile profile, double fwhm_px, double radius_px) {
  const PixelImage image(profile, fwhm_px);
  constexpr int phases = 6; // of half a pixel, in x and in y: the rest are mirror images
  const int side = 2 * static_cast<int>(std::ceil(radius_px)) + 5;
  const double middle = (side - 1) / 2.; // of an odd side: a pixel's
  double out = 0;
  for (int kx = 0; kx < phases; ++kx)
    for (int ky = 0; ky < phases; ++ky) {
      const FramePoint centre{middle + 0.5 * kx / (phases - 1), middle + 0.5 * ky / (phases - 1)};
      const FrameAperture aperture{{centre}, radius_px, 0, 0};
      std::array<double, 4> light{};
      for (std::size_t place = 0; place < 4; ++place) {
        LatticeValues only{};
        only[place] = 1;
        PixelFrame frame = PixelFrame::blank(side, side);
        image.add(frame, centre.x, centre.y, only);
        light[place] = light_in(frame, aperture);
      }
      // Places of crossed analysers stand across the lattice from each other.
      out = std::max({out, std::abs(light[3] - light[0]) / (light[3] + light[0]),
                      std::abs(light[1] - light[2]) / (light[1] + light[2])});
    }
  return out;
}

} // namespace umov
