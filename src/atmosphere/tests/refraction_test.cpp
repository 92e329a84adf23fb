#include "atmosphere/tests/anchor.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/atmosphere/refraction.h>
#include <umov/photometry/radiometry.h>

namespace umov {
namespace {

constexpr double arc_seconds = 3600;
constexpr SurfaceAir air{693.28, 293.15, 10.67};
const Angle at_30 = Angle::degrees(30); // 60 deg from the zenith

TEST(Refraction, FollowsFilippenko) { // nine digits
  EXPECT_NEAR(refraction(550, at_30, air).degrees() * arc_seconds, of("refraction_60"), 1e-7);
}

TEST(Refraction, SpreadsColours) { // differences of the above
  const auto spread = [](double blue, double red) {
    return (refraction(blue, at_30, air).degrees() - refraction(red, at_30, air).degrees()) *
           arc_seconds;
  };
  EXPECT_NEAR(spread(425, 550), of("dispersion_425_550"), 1e-8);
  EXPECT_NEAR(spread(550, 650), of("dispersion_550_650"), 1e-8);
  EXPECT_NEAR(spread(400, 700), of("dispersion_400_700"), 1e-8);
}

TEST(Refraction, SpreadsColoursAsGalsimHasIt) { // tools/oracles/refraction_galsim.py
  const Anchors table("../air/refraction_galsim");
  ASSERT_EQ(table.size(), 20U);
  for (const AnchorRow &row : table) {
    const SurfaceAir there{row["pressure_hpa"], row["temperature_k"], row["water_hpa"]};
    const auto of = [&](double nm) {
      return refraction(nm, Angle::degrees(90 - row["zenith_deg"]), there).degrees() * arc_seconds;
    };
    const double expected = row["refraction_arcsec"] - row["at_550_arcsec"];
    EXPECT_NEAR(of(row["nm"]), row["refraction_arcsec"], 1e-6 * row["refraction_arcsec"]);
    EXPECT_NEAR(of(row["nm"]) - of(550), expected, 1e-6 * std::abs(expected) + 1e-9); // ten digits
  }
}

TEST(Refraction, StaysFiniteAtTheHorizon) {
  // 34 arc minutes at 1010 hPa and 283 K for an apparent altitude of 0, about 29 for a true one
  // (Explanatory Supplement 1992, 9.33); a tenth for the joint at 15 deg.
  const SurfaceAir sea{1010, 283.15, 0};
  EXPECT_NEAR(refraction(575, Angle::degrees(0), sea).degrees() * 60, 29, 2.9);
  const double above = refraction(550, Angle::degrees(15 + 1e-9), sea).degrees();
  const double below = refraction(550, Angle::degrees(15 - 1e-9), sea).degrees();
  EXPECT_NEAR(above, below, 1e-8);
}

TEST(Refraction, AirMassIsThatOfTheApparentAltitude) {
  for (const int altitude : {60, 30, 10, 5}) // nine digits
    EXPECT_NEAR(airmass(Angle::degrees(altitude)), of("airmass_" + std::to_string(altitude)), 6e-8);
  // At 10 deg the true altitude would give half a per cent too much.
  const Angle seen = apparent_altitude(550, Angle::degrees(10), air);
  EXPECT_NEAR(airmass(seen) / airmass(Angle::degrees(10)) - 1, -0.0056, 5e-4);
}

} // namespace
} // namespace umov
