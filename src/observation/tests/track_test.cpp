// Geometry, attitude and joints of one epoch put together.

#include "observation/tests/straight_line.h"

#include <gtest/gtest.h>

namespace umov {
namespace {

const cases::StraightLine line("2018-03-20T12:00:00Z");

TEST(Track, ThePoseIsTheGeometryInBodyAxes) {
  const Track track = Track::make(line.request()).value();
  for (const double s : {0.0, 130.0, 300.0, 1100.0}) {
    const auto point = track.at(plus_seconds(line.start, s));
    ASSERT_TRUE(point) << point.error().text();
    const ObservingGeometry &g = point->geometry;
    EXPECT_NEAR(norm(point->pose.sun), 1, 1e-15);
    EXPECT_NEAR(norm(point->pose.observer), 1, 1e-15);
    EXPECT_NEAR(angle_between(point->pose.sun, point->pose.observer), g.phase_angle.radians(),
                1e-12);
    // The default law: +Z to the Earth's centre.
    const Vec3<Body> down = point->body_from_gcrs * normalized(-g.gcrs_km);
    EXPECT_NEAR(norm(down - Vec3<Body>{0, 0, 1}), 0, 1e-12);
    EXPECT_EQ(point->pose.sun_radius_rad, sun_radius_rad(g));
  }
}

TEST(Track, APointSunHasNoRadius) {
  TrackRequest request = line.request();
  request.has_solar_disk = false;
  EXPECT_EQ(Track::make(request)->at(line.start)->pose.sun_radius_rad, 0);
}

TEST(Track, JointsStandAtTheirAngleOrFollowATable) {
  TrackRequest request = line.request();
  const AngleTable table{{line.start, plus_seconds(line.start, 100)}, {0, 1}};
  request.joints = {{Joint(), 0.3}, {Joint(), table}};
  const Track track = Track::make(request).value();
  const auto point = track.at(plus_seconds(line.start, 25));
  ASSERT_TRUE(point) << point.error().text();
  ASSERT_EQ(point->joint_angles_rad.size(), 2u);
  EXPECT_EQ(point->joint_angles_rad[0], 0.3);
  EXPECT_NEAR(point->joint_angles_rad[1], 0.25, 1e-9);
  EXPECT_EQ(track.at(plus_seconds(line.start, 500))->joint_angles_rad[1], 1); // constant beyond
}

TEST(Track, SaysWhereTheOrbitEnds) {
  const auto point = Track::make(line.request())->at(plus_seconds(line.start, 1201));
  ASSERT_FALSE(point);
  EXPECT_EQ(point.error().code, ErrorCode::Physics);
}

TEST(Track, TheHalfVectorMovesNoFasterThanTheRate) {
  const Track track = Track::make(line.request()).value();
  std::vector<ObservingGeometry> samples;
  std::vector<Vec3<Body>> half;
  for (double s = 0; s <= 500; s += 5) {
    const auto point = track.at(plus_seconds(line.start, s));
    samples.push_back(point->geometry);
    half.push_back(normalized(point->pose.sun + point->pose.observer));
  }
  const double rate = track.half_vector_rate(samples);
  for (std::size_t k = 1; k < half.size(); ++k)
    EXPECT_LE(angle_between(half[k], half[k - 1]) / 5, rate);
}

} // namespace
} // namespace umov
