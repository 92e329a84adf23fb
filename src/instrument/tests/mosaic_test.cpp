#include "instrument/tests/anchor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <umov/instrument/mosaic.h>
#include <umov/instrument/pixel_image.h>

namespace umov {
namespace {

TEST(Mosaic, AliasIsThatOfPixelSums) {
  for (const char *fwhm : {"1.5", "2", "2.5", "3"}) // sums over 61 pixels, nine digits
    EXPECT_NEAR(mosaic_alias(AnchorRow::number(fwhm), 0, 0).q, of(std::string("mosaic_q_") + fwhm),
                1e-9);
  EXPECT_NEAR(mosaic_alias(2, .3, .1).q, of("mosaic_off_q"), 1e-9);
  EXPECT_NEAR(mosaic_alias(2, .3, .1).u, of("mosaic_off_u"), 1e-9);
}

/// A Gaussian's light on pixel k of a row, its centre at x.
double on_pixel(int k, double x, double sigma) {
  const double root = sigma * std::sqrt(2.);
  return (std::erf((k + .5 - x) / root) - std::erf((k - .5 - x) / root)) / 2;
}

TEST(Mosaic, AliasIsThatOfPixelSumsAtAnyPhase) {
  for (const double fwhm : {1., 1.5, 2., 2.5, 3., 4.})
    for (const double x : {0., .1, .37, .5})
      for (const double y : {0., .24, .45}) {
        const double sigma = fwhm / std::sqrt(8 * std::log(2.));
        double even_x = 0, even_y = 0; // light in even columns and rows
        for (int k = -30; k <= 30; k += 2)
          even_x += on_pixel(k, x, sigma), even_y += on_pixel(k, y, sigma);
        // Layout 90 45 / 135 0, x to the right, y down, pixel (0, 0) first.
        const double n90 = even_x * even_y, n45 = (1 - even_x) * even_y;
        const double n135 = even_x * (1 - even_y), n0 = (1 - even_x) * (1 - even_y);
        const MosaicAlias alias = mosaic_alias(fwhm, x, y);
        EXPECT_NEAR(alias.q, (n0 - n90) / (n0 + n90), 1e-9) << fwhm << " " << x << " " << y;
        EXPECT_NEAR(alias.u, (n45 - n135) / (n45 + n135), 1e-9) << fwhm << " " << x << " " << y;
      }
}

/// Light of a Gaussian star at (x, y) in the pixels of each place within a radius.
std::array<double, 4> light_within(double radius, double fwhm, double x, double y) {
  const double sigma = fwhm / std::sqrt(8 * std::log(2.));
  std::array<double, 4> out{};
  for (int row = -20; row <= 20; ++row)
    for (int column = -20; column <= 20; ++column)
      if (std::hypot(column - x, row - y) <= radius)
        out[2 * static_cast<std::size_t>(row & 1) + static_cast<std::size_t>(column & 1)] +=
            on_pixel(column, x, sigma) * on_pixel(row, y, sigma);
  return out;
}

TEST(Mosaic, AnEdgeCutsTheOrientationsUnevenly) {
  struct Case {
    double fwhm, radius;
  };
  for (const Case &one : {Case{3, 4}, {3, 6}, {4, 4}, {6, 6}}) {
    double worst = 0;
    for (int kx = 0; kx <= 20; ++kx)
      for (int ky = 0; ky <= 20; ++ky) {
        const auto n = light_within(one.radius, one.fwhm, .025 * kx, .025 * ky);
        worst = std::max(
            {worst, std::abs(n[3] - n[0]) / (n[3] + n[0]), std::abs(n[1] - n[2]) / (n[1] + n[2])});
      }
    const double found = mosaic_aperture_alias(ImageProfile::Gauss, one.fwhm, one.radius);
    // Fewer phases miss part of the largest; it is a warning's figure.
    EXPECT_LT(found, worst * 1.02) << one.fwhm << " " << one.radius;
    EXPECT_GT(found, worst / 2) << one.fwhm << " " << one.radius;
  }
  // A wide aperture has no edge in the light: sampling alone.
  EXPECT_NEAR(mosaic_aperture_alias(ImageProfile::Gauss, 2, 8) / mosaic_alias(2, 0, 0).q, -1, 1e-2);
}

/// A box with hard edges that follows the star, summed from the images that frames are made of:
/// root mean square and largest false q over phases (anchors: error functions, summed pixel by
/// pixel).
TEST(Mosaic, AHardBoxAddsItsOwn) {
  struct Case {
    double fwhm, half;
    const char *name;
  };
  for (const Case &one : {Case{3, 4, "box_3_4"}, {3, 6, "box_3_6"}, {4, 6, "box_4_6"}}) {
    const PixelImage image(ImageProfile::Gauss, one.fwhm);
    double squares = 0, worst = 0;
    constexpr int phases = 17;
    for (int kx = 0; kx < phases; ++kx)
      for (int ky = 0; ky < phases; ++ky) {
        const double x = 24 + kx / 8., y = 24 + ky / 8.;
        PixelFrame frame = PixelFrame::blank(48, 48);
        image.add(frame, x, y, {1, 1, 1, 1});
        std::array<double, 4> n{};
        for (int row = 0; row < 48; ++row)
          for (int column = 0; column < 48; ++column)
            if (std::abs(column - x) <= one.half && std::abs(row - y) <= one.half)
              n[lattice_place(column, row)] += frame.value[frame.index(column, row)];
        const double q = (n[3] - n[0]) / (n[3] + n[0]); // layout 90 45 / 135 0
        squares += q * q / (phases * phases);
        worst = std::max(worst, std::abs(q));
      }
    // The image's table is within 7e-5 of its peak, a tenth of the light.
    EXPECT_NEAR(std::sqrt(squares), of(std::string(one.name) + "_rms"), 1e-5) << one.name;
    EXPECT_NEAR(worst, of(std::string(one.name) + "_worst"), 3e-5) << one.name;
  }
}

TEST(Mosaic, DriftAveragesIt) {
  EXPECT_EQ(drift_factor(0), 1);
  EXPECT_NEAR(drift_factor(2), 0, 1e-15); // a whole period of the lattice
  EXPECT_NEAR(drift_factor(5), 1 / (2.5 * 3.14159265358979), 1e-12);
}

} // namespace
} // namespace umov
