#include "core/tests/anchors.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/optics/emission.h>

namespace umov {
namespace {

TEST(Emission, SmoothSurfacesMatchThePrintedValues) {
  for (const AnchorRow &row : Anchors("emission")) { // six digits
    const Emissivity e =
        smooth_emissivity(Interface({row["n"], row["k"]}), std::cos(row["theta_deg"] * pi / 180));
    EXPECT_NEAR(e.i, row["e"], 5.1e-7);
    EXPECT_NEAR(e.q / e.i, row["q"], 5.1e-7);
  }
}

TEST(Emission, PlanckAtRoomTemperature) {
  // W m-2 sr-1 um-1, six digits after the point.
  EXPECT_NEAR(planck_radiance(Wavelength::nm(10'000), 300) * 1000, anchor("planck_10um_300K"),
              5.1e-7);
  EXPECT_EQ(planck_radiance(Wavelength::nm(550), 0), 0);
  EXPECT_EQ(planck_radiance(Wavelength::nm(550), 3), 0); // e^-8700: an honest underflow
}

} // namespace
} // namespace umov
