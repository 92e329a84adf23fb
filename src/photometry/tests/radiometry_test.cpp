#include "core/tests/anchors.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/constants.h>
#include <umov/photometry/earthshine.h>
#include <umov/photometry/radiometry.h>

namespace umov {
namespace {

TEST(Airmass, MatchesKastenAndYoung) {
  for (const AnchorRow &row : Anchors("airmass")) // six digits after the point
    EXPECT_NEAR(airmass(Angle::degrees(90 - row["zenith_deg"])), row["airmass"], 5e-7);
  EXPECT_TRUE(std::isnan(airmass(Angle::degrees(-0.1))));
}

TEST(AbMagnitude, IsZeroAtItsZeroPoint) {
  // 3631 Jy at 550 nm: f_lambda = f_nu c / lambda^2 = 3.598501e-11 W m-2 nm-1.
  EXPECT_NEAR(ab_magnitude(3.598501e-11, Wavelength::nm(550)), 0, 1e-6);
  EXPECT_TRUE(std::isnan(ab_magnitude(0, Wavelength::nm(550))));
}

TEST(Irradiance, LambertSphereAgainstTheSunsOwnMagnitude) {
  // R = 1 m, rho = .2, phase 90, 1000 km, the Sun at -26.76 (Willmer 2018); four digits. Intensity
  // rho R^2 2/(3 pi); a magnitude difference needs no band.
  const double white = 0.2 * 2 / (3 * pi);
  const double ratio = irradiance_at_observer(white, 1.0, constants::au_km, 1.0, 1000.0);
  EXPECT_NEAR(-26.76 - 2.5 * std::log10(ratio), anchor("lambert_sphere_magnitude"), 5e-5);
  // Mirror sphere, R = 1 m, F = .9: F R^2/4 at any phase.
  const double mirror = irradiance_at_observer(0.9 / 4, 1.0, constants::au_km, 1.0, 1000.0);
  EXPECT_NEAR(-26.76 - 2.5 * std::log10(mirror), anchor("mirror_sphere_magnitude"), 5e-5);
}

TEST(Earthshine, MatchesThePrintedValues) {
  // A = .3; in low orbit above the subsolar point and 60 deg from it, and from GEO.
  for (const AnchorRow &row : Anchors("earthshine")) {
    const Earthshine light = earthshine(.3, row["radius_km"], Angle::degrees(row["zenith_deg"]));
    const double tolerance = row["radius_km"] > 40'000 ? 1e-7 : 2e-6;
    EXPECT_NEAR(light.on_nadir_facet, row["facet"], tolerance);
    EXPECT_NEAR(light.omnidirectional, row["around"], tolerance);
  }
}

} // namespace
} // namespace umov
