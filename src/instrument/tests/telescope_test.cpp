#include "instrument/tests/anchor.h"

#include <cmath>
#include <gtest/gtest.h>
#include <tuple>
#include <umov/instrument/telescope.h>

namespace umov {
namespace {

TEST(Telescope, AreaAndScale) {
  Telescope t;
  t.aperture_m = .2794;
  t.obstruction = .34;
  t.focal_length_m = 2.794;
  EXPECT_NEAR(collecting_area_m2(t), of("area_c11"), 1e-10);
  EXPECT_NEAR(pixel_scale_arcsec(t, 3.45), .2547, 5e-5); // 3.45 um/2.794 m in arc seconds
}

TEST(Telescope, SharesAreThoseOfTheProfiles) {
  // A Gaussian: half within half a width. Moffat: radial integral, nine digits of it good to 1e-6.
  EXPECT_NEAR(share_inside(ImageProfile::Gauss, .5), .5, 1e-15);
  for (const char *radius : {"0.5", "1", "1.5"})
    EXPECT_NEAR(share_inside(ImageProfile::Moffat, AnchorRow::number(radius)),
                of(std::string("moffat_") + radius), 1e-6);
}

TEST(Telescope, TrailsHaveTheLightOfTheirNeighbourhood) {
  for (const auto &[profile, name] :
       {std::pair{ImageProfile::Gauss, "trail_gauss_"}, {ImageProfile::Moffat, "trail_moffat_"}}) {
    for (const auto &[radius, length, key] :
         {std::tuple{.5, 1., "0.5_1"}, {1., 3., "1_3"}, {2., 10., "2_10"}})
      // Square roots at the edge of the path's neighbourhood: 2e-6 by Gauss' rule of 20 points.
      EXPECT_NEAR(share_along(profile, radius, length), of(std::string(name) + key), 5e-6) << key;
    for (const auto &[length, key] :
         {std::pair{1., "peak_1"}, {10., "peak_10"}}) // tails beyond 4 widths
      EXPECT_NEAR(peak_along(profile, length), of(std::string(name) + key), 1e-6) << key;
    EXPECT_EQ(share_along(profile, 1, 0), share_inside(profile, 1));
    // A run of nothing changes nothing, one without an end leaves a strip: of Gauss' erf.
    EXPECT_NEAR(share_along(profile, 1, 1e-6), share_inside(profile, 1), 1e-6);
  }
  EXPECT_NEAR(share_along(ImageProfile::Gauss, .5, 1e6), std::erf(std::sqrt(std::log(2.))), 5e-6);
}

TEST(Telescope, SeeingGoesWithAirAndColour) { // nine digits
  EXPECT_NEAR(seeing_fwhm_arcsec({1, 500, 0}, 650, 2), of("seeing"), 1e-8);
  EXPECT_NEAR(seeing_fwhm_arcsec({1, 500, 25}, 650, 2), of("seeing_outer"), 1e-8);
}

TEST(Telescope, TrailOfALens) {
  // .5 deg/s, .1 s, 16"/px: 1800" * .1 / 16.
  EXPECT_NEAR(trail_length_px(.5 * pi / 180, .1, 16), 11.25, 1e-12);
}

TEST(Telescope, AxesKeepToTheMountOrToTheSky) {
  Telescope t;
  const Angle x = Angle::degrees(30), eta = Angle::degrees(-36.8);
  const Angle altitude = Angle::degrees(50);
  EXPECT_EQ(axis_from_zenith(t, x, eta, altitude).degrees(), x.degrees());
  t.has_derotator = true;
  const double derotated = axis_from_zenith(t, x, eta, altitude).degrees();
  t.has_derotator = false;
  t.mount = Mount::Equatorial;
  EXPECT_EQ(axis_from_zenith(t, x, eta, altitude).degrees(), derotated);
  EXPECT_NEAR(derotated, 66.8, 1e-12); // from north it is 30: 36.8 more from the zenith
}

} // namespace
} // namespace umov
