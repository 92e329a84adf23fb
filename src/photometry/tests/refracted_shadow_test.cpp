// Light at the edge of the Earth's shadow with its air.

#include <umov/photometry/refracted_shadow.h>

#include <cmath>
#include <gtest/gtest.h>

namespace umov {
namespace {

constexpr double earth_km = 6378.137;
const Angle disk = Angle::degrees(0.2666);

double light(double distance_km, double above_limb_deg, double nm) {
  const Angle limb = Angle::radians(std::asin(earth_km / distance_km));
  return refracted_sunlight(disk, earth_km, distance_km,
                            Angle::degrees(limb.degrees() + above_limb_deg), Wavelength::nm(nm));
}

TEST(RefractedShadow, OneOutsideAndFallingWithoutJumps) {
  for (const double distance : {6778.0, 7178.0, 42164.0})
    for (const double nm : {425.0, 550.0, 650.0}) {
      EXPECT_NEAR(light(distance, 3, nm), 1, 1e-12);
      double before = light(distance, 1.5, nm);
      EXPECT_GT(before, 0.97);
      for (double above = 1.5; above > -3; above -= 0.01) {
        const double now = light(distance, above, nm);
        EXPECT_LE(now, before + 1e-4) << above;
        EXPECT_GT(now, before - 0.03) << above;
        EXPECT_GE(now, 0);
        before = now;
      }
    }
}

TEST(RefractedShadow, ReddensAndReachesIntoTheUmbra) {
  // Behind the geometric edge of the umbra (0.2666 deg) light still comes, redder the deeper.
  double before = 1;
  for (const double above : {0.2, 0.0, -0.2, -0.4, -0.6}) {
    const double ratio = light(7178, above, 425) / light(7178, above, 650);
    EXPECT_LT(ratio, before) << above;
    before = ratio;
  }
  EXPECT_GT(light(7178, -0.4, 650), 1e-4);
  EXPECT_LT(light(7178, -0.4, 650), 0.05);
  // Beyond the largest bending nothing is left.
  EXPECT_EQ(light(7178, -1.6, 650), 0);
}

TEST(RefractedShadow, FarAboveTheAirItIsTheDisksGeometry) {
  // The air of a scale height of 8 km is 0.1 deg high from 4,500 km: in the penumbra of an object
  // so far away the light is lower than the geometric half, by what the air takes.
  const double half = light(42164, 0, 550);
  EXPECT_LT(half, 0.5);
  EXPECT_GT(half, 0.4);
}

} // namespace
} // namespace umov
