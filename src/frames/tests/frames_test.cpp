#include <cmath>
#include <gtest/gtest.h>
#include <umov/frames/earth.h>
#include <umov/frames/site.h>
#include <umov/frames/sky.h>

namespace umov {
namespace {

TEST(Site, ChecksItsRanges) {
  EXPECT_TRUE(make_site("pole", 90, 180, 0));
  EXPECT_TRUE(make_site("Dead Sea", 31.5, 35.5, -430));
  EXPECT_FALSE(make_site("", 90.1, 0, 0));
  EXPECT_FALSE(make_site("", std::nan(""), 0, 0));
  EXPECT_FALSE(make_site("", 0, 400, 0));
  EXPECT_FALSE(make_site("", 0, 0, 1e6));
}

TEST(Site, StandsOnTheEllipsoid) {
  // WGS 84: semi-axes 6378.137 and 6356.752314 km.
  EXPECT_NEAR(itrs_position_km(*make_site("", 0, 90, 0)).y, 6378.137, 1e-9);
  EXPECT_NEAR(itrs_position_km(*make_site("", 90, 0, 1000)).z, 6357.752314245, 1e-6);
  const auto enu = enu_from_itrs(*make_site("", 0, 0, 0));
  EXPECT_NEAR((enu * Vec3<Itrs>{1, 0, 0}).z, 1, 1e-15); // up
  EXPECT_NEAR((enu * Vec3<Itrs>{0, 1, 0}).x, 1, 1e-15); // east
  EXPECT_NEAR((enu * Vec3<Itrs>{0, 0, 1}).y, 1, 1e-15); // north
}

TEST(Frames, TemeAndGcrsDifferByPrecessionOnly) {
  // The celestial pole has moved by about 20.04 arcsec a year since 2000 (IAU 2006): at 2018.055
  // the pole of date is .1005 deg from that of the GCRS, within nutation (10 arcsec).
  const auto time = *utc_from_iso("2018-01-21T05:00:00Z");
  const auto gcrs_from_teme = itrs_from_gcrs(time).inverse() * itrs_from_teme(time);
  const Vec3<Gcrs> pole = gcrs_from_teme * Vec3<Teme>{0, 0, 1};
  EXPECT_NEAR(std::acos(pole.z) * 180 / pi, 20.04 * 18.055 / 3600, 10.0 / 3600);
}

TEST(Sky, PositionAnglesTurnThroughEast) {
  // Object at RA 0 on the equator: the observer sees it along +x, v = -x; north is +z, east is +y.
  const Vec3<Gcrs> v{-1, 0, 0}, north{0, 0, 1};
  EXPECT_NEAR(position_angle({0, 0, 1}, north, v).degrees(), 0, 1e-12);
  EXPECT_NEAR(position_angle(normalized(Vec3<Gcrs>{0, 1, 1}), north, v).degrees(), 45, 1e-12);
  EXPECT_NEAR(position_angle({0, -1, 0}, north, v).degrees(), 90, 1e-12);
  EXPECT_GE(position_angle({0, 1e-18, -1}, north, v).degrees(), 0);
  EXPECT_LT(position_angle({0, 1e-18, -1}, north, v).degrees(), 180);
}

TEST(Sky, TurningTheReferenceTurnsTheAngleBack) {
  const Vec3<Gcrs> v = normalized(Vec3<Gcrs>{-0.3, 0.5, 0.7}), s = any_perpendicular(v);
  const Vec3<Gcrs> north{0, 0, 1};
  const Vec3<Gcrs> n = normalized(north - dot(north, v) * v), e = cross(v, n);
  const double chi = 0.4;
  const Vec3<Gcrs> turned = std::cos(chi) * n + std::sin(chi) * e;
  const double before = position_angle(s, north, v).radians();
  const double after = position_angle(s, turned, v).radians();
  EXPECT_NEAR(std::sin(2 * (before - chi - after)), 0, 1e-12);
}

TEST(Sky, DirectionRoundTrip) {
  const SkyDirection d = sky_direction(unit_vector({Angle::degrees(350), Angle::degrees(-5)}));
  EXPECT_NEAR(d.right_ascension.degrees(), 350, 1e-12);
  EXPECT_NEAR(d.declination.degrees(), -5, 1e-12);
}

} // namespace
} // namespace umov
