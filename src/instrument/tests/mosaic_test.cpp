#include "instrument/tests/anchor.h"

#include <gtest/gtest.h>
#include <umov/instrument/mosaic.h>

namespace umov {
namespace {

TEST(Mosaic, AliasIsThatOfPixelSums) {
  for (const char *fwhm : {"1.5", "2", "2.5", "3"}) // sums over 61 pixels
    EXPECT_NEAR(mosaic_alias(AnchorRow::number(fwhm), 0, 0).q, of(std::string("mosaic_q_") + fwhm),
                2e-8); // its third harmonic, of a width of 1.5 px
  EXPECT_NEAR(mosaic_alias(2, .3, .1).q, of("mosaic_off_q"),
              2e-8); // its third harmonic, of a width of 1.5 px
  EXPECT_NEAR(mosaic_alias(2, .3, .1).u, of("mosaic_off_u"), 1e-8);
}

/// A Gaussian's light on pixel k of a row, its centre at x.
double on_pixel(int k, double x, double sigma) {
  const double root = sigma * std::sqrt(2.);
  return (std::erf((k + .5 - x) / root) - std::erf((k - .5 - x) / root)) / 2;
}

TEST(Mosaic, AliasIsThatOfPixelSumsAtAnyPhase) {
  for (const double fwhm : {1.5, 2., 2.5, 3., 4.})
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
        EXPECT_NEAR(alias.q, (n0 - n90) / (n0 + n90), 1e-6) << fwhm << " " << x << " " << y;
        EXPECT_NEAR(alias.u, (n45 - n135) / (n45 + n135), 1e-6) << fwhm << " " << x << " " << y;
      }
}

TEST(Mosaic, DriftAveragesIt) {
  EXPECT_EQ(drift_factor(0), 1);
  EXPECT_NEAR(drift_factor(2), 0, 1e-15); // a whole period of the lattice
  EXPECT_NEAR(drift_factor(5), 1 / (2.5 * 3.14159265358979), 1e-12);
}

} // namespace
} // namespace umov
