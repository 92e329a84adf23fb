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

TEST(Mosaic, DriftAveragesIt) {
  EXPECT_EQ(drift_factor(0), 1);
  EXPECT_NEAR(drift_factor(2), 0, 1e-15); // a whole period of the lattice
  EXPECT_NEAR(drift_factor(5), 1 / (2.5 * 3.14159265358979), 1e-12);
}

} // namespace
} // namespace umov
