#include "instrument/tests/anchor.h"

#include <gtest/gtest.h>
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
