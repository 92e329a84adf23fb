// What is interpolated between whole hours, beside ERFA at the very time.

#include <cmath>
#include <erfa.h>
#include <gtest/gtest.h>
#include <umov/core/quantity.h>
#include <umov/frames/earth.h>
#include <umov/time/earth_orientation.h>
#include <umov/time/hourly.h>

namespace umov {
namespace {

std::array<double, 2> cubic_and_wave(double jd1, double jd2) {
  const double hours = ((jd1 - 2451545) + jd2) * 24, t = hours - 1000;
  return {t * t * t - 2 * t, std::sin(2 * pi * hours / 48)};
}

TEST(Hourly, IsExactForACubicAndWithinItsBoundForAWave) {
  Hourly<2> f(cubic_and_wave);
  for (double hours = 990; hours < 1010; hours += 0.0517) {
    const auto [cubic, wave] = f({2451545, hours / 24});
    const auto exact = cubic_and_wave(2451545, hours / 24);
    EXPECT_NEAR(cubic, exact[0], 1e-7); // the date's rounding of 2e-11 h, times 300
    EXPECT_NEAR(wave, exact[1], 0.024 * std::pow(2 * pi / 48, 4));
  }
}

TEST(Hourly, DoesNotRememberWhatWasAsked) {
  Hourly<2> fresh(cubic_and_wave), used(cubic_and_wave);
  for (const double hours : {5000.5, -63.2, 1.5, 65.5, 129.5, 1064.25})
    (void)used({2451545, hours / 24});
  EXPECT_EQ(fresh({2451545, 1000.3 / 24}), used({2451545, 1000.3 / 24}));
}

TEST(Frames, TheCelestialPoleIsThatOfErfa) {
  for (int day = 0; day < 12'000; day += 97) { // 1995 to 2027
    const Epoch<Utc> time =
        plus_seconds(*utc_from_iso("1995-01-03T00:00:00Z"), 86400. * day + 7919. * (day % 11));
    const EarthOrientation eo = earth_orientation(time);
    const Epoch<Tt> tt = tt_from(time);
    double ut1[2], m[3][3];
    eraUtcut1(time.jd1, time.jd2, eo.dut1_s, &ut1[0], &ut1[1]);
    eraC2t06a(tt.jd1, tt.jd2, ut1[0], ut1[1], eo.x_p_rad, eo.y_p_rad, m);
    const auto ours = itrs_from_gcrs(time);
    for (int row = 0; row < 3; ++row) {
      // 1e-9 arcsec is 5e-15; the Earth's turning angle is rounded to 1e-14 (0.1 ns).
      EXPECT_NEAR(ours.row(row).x, m[row][0], 2e-14) << day;
      EXPECT_NEAR(ours.row(row).y, m[row][1], 2e-14) << day;
      EXPECT_NEAR(ours.row(row).z, m[row][2], 2e-14) << day;
    }
  }
}

} // namespace
} // namespace umov
