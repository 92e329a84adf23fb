#include <cmath>
#include <gtest/gtest.h>
#include <umov/optics/emission.h>

namespace umov {
namespace {

TEST(Emission, SmoothSurfacesMatchThePrintedValues) {
  // physics page, section 8: n = 25.3 + 90i and n = 1.518; six digits.
  const struct {
    std::complex<double> eta;
    double theta, i, q;
  } rows[] = {{{25.3, 90}, 60, .014328, -.597172},
              {{25.3, 90}, 80, .033155, -.939426},
              {{1.518, 0}, 60, .907845, -.099798}};
  for (const auto &row : rows) {
    const Emissivity e = smooth_emissivity(Interface(row.eta), std::cos(row.theta * pi / 180));
    EXPECT_NEAR(e.i, row.i, 5.1e-7);
    EXPECT_NEAR(e.q / e.i, row.q, 5.1e-7);
  }
}

TEST(Emission, PlanckAtRoomTemperature) {
  // physics page: B(10 um, 300 K) = 9.924033 W m-2 sr-1 um-1.
  EXPECT_NEAR(planck_radiance(Wavelength::nm(10'000), 300) * 1000, 9.924033, 5.1e-7);
  EXPECT_EQ(planck_radiance(Wavelength::nm(550), 0), 0);
  EXPECT_EQ(planck_radiance(Wavelength::nm(550), 3), 0); // e^-8700: an honest underflow
}

} // namespace
} // namespace umov
