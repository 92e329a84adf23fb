#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/constants.h>
#include <umov/photometry/earthshine.h>
#include <umov/photometry/radiometry.h>

namespace umov {
namespace {

TEST(Airmass, MatchesKastenAndYoung) {
  // physics page, section 8, six digits after the point.
  EXPECT_NEAR(airmass(Angle::degrees(30)), 1.994293, 5e-7);
  EXPECT_NEAR(airmass(Angle::degrees(10)), 5.586036, 5e-7);
  EXPECT_TRUE(std::isnan(airmass(Angle::degrees(-0.1))));
}

TEST(AbMagnitude, IsZeroAtItsZeroPoint) {
  // 3631 Jy at 550 nm: f_lambda = f_nu c / lambda^2 = 3.598501e-11 W m-2 nm-1.
  EXPECT_NEAR(ab_magnitude(3.598501e-11, Wavelength::nm(550)), 0, 1e-6);
  EXPECT_TRUE(std::isnan(ab_magnitude(0, Wavelength::nm(550))));
}

TEST(Irradiance, LambertSphereAgainstTheSunsOwnMagnitude) {
  // physics page, section 7: R = 1 m, rho = .2, phase 90, 1000 km, Sun -26.76: magnitude 6.6705.
  // Intensity rho R^2 .212207; a magnitude difference needs no band.
  const double ratio = irradiance_at_observer(0.2 * 0.212207, 1.0, constants::au_km, 1.0, 1000.0);
  EXPECT_NEAR(-26.76 - 2.5 * std::log10(ratio), 6.6705, 5e-5);
  // Mirror sphere, R = 1 m, F = .9: F R^2/4 at any phase: 4.8595.
  const double mirror = irradiance_at_observer(0.9 / 4, 1.0, constants::au_km, 1.0, 1000.0);
  EXPECT_NEAR(-26.76 - 2.5 * std::log10(mirror), 4.8595, 5e-5);
}

TEST(Earthshine, MatchesThePrintedValues) {
  // physics page, section 8: A = .3, R_E = 6378.137 km; 500 km above the subsolar point .256499
  // (nadir facet), .372459 (omnidirectional); 60 deg from it half of that; GEO .0050747, .0050997.
  const Earthshine low = earthshine(.3, 6878.137, Angle::degrees(0));
  EXPECT_NEAR(low.on_nadir_facet, .256499, 2e-6);
  EXPECT_NEAR(low.omnidirectional, .372459, 2e-6);
  const Earthshine aside = earthshine(.3, 6878.137, Angle::degrees(60));
  EXPECT_NEAR(aside.on_nadir_facet, .128249, 2e-6);
  EXPECT_NEAR(aside.omnidirectional, .186229, 2e-6);
  const Earthshine far = earthshine(.3, 42164, Angle::degrees(0));
  EXPECT_NEAR(far.on_nadir_facet, .0050747, 1e-7);
  EXPECT_NEAR(far.omnidirectional, .0050997, 1e-7);
}

} // namespace
} // namespace umov
