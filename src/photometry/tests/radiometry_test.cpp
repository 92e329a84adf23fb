#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/constants.h>
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
}

} // namespace
} // namespace umov
