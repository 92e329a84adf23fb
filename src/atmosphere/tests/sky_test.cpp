#include "atmosphere/tests/anchor.h"

#include <gtest/gtest.h>
#include <umov/atmosphere/sky_brightness.h>
#include <umov/atmosphere/sky_polarization.h>

namespace umov {
namespace {

Vec3<Enu> at(double azimuth, double altitude) {
  return horizontal_direction(Angle::degrees(azimuth), Angle::degrees(altitude));
}

TEST(ScatteredSky, DegreeAndAxis) { // nine digits
  const auto a = scattered_sky(at(270, -6), at(180, 45), .8);
  EXPECT_NEAR(a.degree, of("sky_a_p"), 1e-9);
  EXPECT_NEAR(a.axis.degrees(), of("sky_a_axis_deg"), 1e-6);
  const auto b = scattered_sky(at(253.969112, -14.897084), at(140.523474, 55.844337), .8);
  EXPECT_NEAR(b.degree, of("sky_b_p"), 1e-9);
  EXPECT_NEAR(b.axis.degrees(), of("sky_b_axis_deg"), 1e-7);
}

TEST(ScatteredSky, IsLargestAcrossTheLight) {
  // (1 - rho)/(1 + rho) with rho = .0279.
  EXPECT_NEAR(scattered_sky(at(0, 0), at(0, 90), 1).degree, .9721 / 1.0279, 1e-15);
  EXPECT_NEAR(scattered_sky(at(0, 0), at(0, 0), 1).degree, 0, 1e-15);
}

TEST(ScatteredSky, MoonlightIsDilutedByTheDarkSky) {
  // 60 deg from the Moon; 660.9944 nL of moonlight on 79.00572 nL without polarization.
  const double moon = scattered_sky(at(0, 30), at(0, 90), .6).degree;
  EXPECT_NEAR(moon, .3441942, 5e-8);
  const double light = of("moonlight_nl"), dark = of("dark_nl");
  EXPECT_NEAR(moon * light / (light + dark), .3074465, 5e-8);
}

TEST(SkyBrightness, TwilightIsTheFit) {
  const std::pair<const char *, SkyBand> bands[] = {
      {"B", SkyBand::B}, {"V", SkyBand::V}, {"R", SkyBand::R}};
  for (const auto &[name, band] : bands)
    for (const int zenith : {96, 100, 104})
      EXPECT_NEAR(twilight_mag(band, Angle::degrees(zenith)),
                  of(std::string("twilight_") + name + "_" + std::to_string(zenith)), 1e-9);
}

TEST(SkyBrightness, NightDoesNotTurnBackIntoDay) {
  // The fit's parabola would brighten again past 108 deg.
  EXPECT_EQ(night_sky_mag(SkyBand::V, Angle::degrees(-25), 21.6), 21.6);
  EXPECT_NEAR(night_sky_mag(SkyBand::V, Angle::degrees(-10), 21.6), 18.005, 1e-9);
  EXPECT_TRUE(std::isnan(night_sky_mag(SkyBand::V, Angle::degrees(-4), 21.6)));
  for (double h = -5; h > -30; h -= .1)
    EXPECT_GE(night_sky_mag(SkyBand::V, Angle::degrees(h - .1), 21.6) + 1e-12,
              night_sky_mag(SkyBand::V, Angle::degrees(h), 21.6));
}

TEST(SkyBrightness, MoonlightAfterKrisciunasAndSchaefer) { // nine digits
  const MoonOnSky moon{Angle::degrees(30), Angle::degrees(60), Angle::degrees(40)};
  const double light = moonlight_nl(moon, Angle::degrees(30), .172);
  EXPECT_NEAR(light, of("moonlight_nl"), 1e-6);
  EXPECT_NEAR(nanolamberts(21.587), of("dark_nl"), 1e-7);
  // Eq. 1 there and back; its constants have five digits.
  EXPECT_NEAR(v_mag_of_nanolamberts(nanolamberts(20)), 20, 1e-12);
  EXPECT_NEAR(v_mag_of_nanolamberts(light), 19.28067, 1e-5);
  EXPECT_NEAR(v_mag_of_nanolamberts(light + nanolamberts(21.587)), 19.15808, 1e-5);
}

} // namespace
} // namespace umov
