// Tables of attitudes, pieces, libration and places on the Earth.

#include <umov/attitude/attitude.h>

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/quantity.h>
#include <umov/frames/earth.h>

namespace umov {
namespace {

const Epoch<Utc> start{2458139.5, 0};

Quaternion about(Vec3<Gcrs> axis, double angle) {
  const Vec3<Gcrs> n = normalized(axis) * std::sin(angle / 2);
  return {std::cos(angle / 2), n.x, n.y, n.z};
}
double difference(const Rotation<Body, Gcrs> &a, const Rotation<Body, Gcrs> &b) {
  double worst = 0;
  for (int k = 0; k < 3; ++k)
    worst = std::max(worst, norm(a.row(k) - b.row(k)));
  return worst;
}
AttitudeContext at(double seconds) {
  return {plus_seconds(start, seconds), {7000, 0, 0}, {0, 7.5, 0}, {0, 0.6, 0.8}, {-0.8, 0, 0.6}};
}
Result<AttitudeContext> context(Epoch<Utc> time) {
  AttitudeContext out = at(0);
  out.time = time;
  return out;
}

/// An even turn is what a great circle gives exactly, whatever the signs of the quaternions.
TEST(AttitudeTable, EvenTurnsBetweenQuaternions) {
  AttitudeTable table{"a", {{}}};
  AttitudeSegment &segment = table.segments[0];
  for (int k = 0; k <= 10; ++k) {
    Quaternion q = about({1, 2, -1}, 0.3 * k);
    if (k % 3 == 0)
      q = {-q.w, -q.x, -q.y, -q.z};
    segment.states.push_back({plus_seconds(start, 10 * k), q, std::nullopt});
  }
  segment.first = start;
  segment.last = plus_seconds(start, 100);
  ASSERT_TRUE(check_attitude_table(table));
  for (double t = 0; t <= 100; t += 1.7) {
    const auto exact = rotation_from<Body, Gcrs>(about({1, 2, -1}, 0.03 * t));
    segment.degree = 1;
    EXPECT_LT(difference(*attitude_in(table, plus_seconds(start, t)), exact), 1e-9);
    segment.degree = 7; // the polynomial of half angles of 0.15 rad a step
    EXPECT_LT(difference(*attitude_in(table, plus_seconds(start, t)), exact), 1e-7);
  }
  const auto outside = attitude_in(table, plus_seconds(start, 101));
  EXPECT_EQ(outside.error().code, ErrorCode::Physics);
  EXPECT_NE(outside.error().message.find("is not given for 2018-01-21T00:01:41.000Z"),
            std::string::npos)
      << outside.error().message;
  std::swap(segment.states[3], segment.states[4]);
  EXPECT_NE(check_attitude_table(table).error().message.find("expected a later time"),
            std::string::npos);
}

/// A spin of -110 deg/s whose axis nods by .005 rad, once in 2 pi s.
SpinState nodding_spin(double t) {
  return {4.7 + 0.005 * std::sin(t), 1.2 + 0.005 * std::cos(t), 2.8 - 1.92 * t + 0.01 * std::sin(t),
          -1.92 + 0.01 * std::cos(t)};
}

/// Half the rows give the other half.
TEST(AttitudeTable, SpinsBetweenTheirPhases) {
  AttitudeTable all{"a", {{}}}, half{"a", {{}}};
  for (int k = 0; k < 5; ++k) {
    const double t = 0.125 * k;
    const AttitudeState state{plus_seconds(start, t), {}, nodding_spin(t)};
    all.segments[0].states.push_back(state);
    if (k % 2 == 0)
      half.segments[0].states.push_back(state);
  }
  for (AttitudeTable *table : {&all, &half}) {
    table->segments[0].first = start;
    table->segments[0].last = plus_seconds(start, 0.5);
  }
  for (const int k : {1, 3}) {
    const Epoch<Utc> time = plus_seconds(start, 0.125 * k);
    // The axis is taken to move evenly over .25 s: off by .25^2/8 of .005 rad/s2 in each angle,
    // 4e-5, and the cubic of the phase by .25^4/384 of .01 rad/s4, 1e-7.
    EXPECT_LT(difference(*attitude_in(all, time), *attitude_in(half, time)), 1e-4);
    const SpinState spin = nodding_spin(0.125 * k);
    const Vec3<Gcrs> axis{std::cos(spin.declination_rad) * std::cos(spin.right_ascension_rad),
                          std::cos(spin.declination_rad) * std::sin(spin.right_ascension_rad),
                          std::sin(spin.declination_rad)};
    EXPECT_LT(norm(attitude_in(all, time)->row(2) - axis), 1e-12);
  }
}

TEST(AttitudeLaws, PiecesFollowEachOther) {
  PiecewiseLaw law;
  law.pieces = {{plus_seconds(start, 10), std::make_shared<AttitudeLaw>(TwoAxisLaw{})},
                {plus_seconds(start, 20),
                 std::make_shared<AttitudeLaw>(
                     SpinLaw{InertialLaw{}, {0, 0, 1}, 0.1, plus_seconds(start, 20)})}};
  ASSERT_TRUE(check_attitude(law));
  const auto ready = Attitude::make(law, context);
  ASSERT_TRUE(ready);
  EXPECT_EQ(ready->at(at(5)).error().code, ErrorCode::Physics);
  EXPECT_LT(norm(ready->at(at(12))->row(2) - Vec3<Gcrs>{-1, 0, 0}), 1e-15); // nadir
  EXPECT_LT(norm(ready->at(at(20 + 5 * pi))->row(0) - Vec3<Gcrs>{0, 1, 0}), 1e-6);
  std::swap(law.pieces[0], law.pieces[1]);
  EXPECT_FALSE(check_attitude(law));
  EXPECT_FALSE(check_attitude(PiecewiseLaw{}));
}

TEST(AttitudeLaws, LibrationHasItsSize) {
  const LibrationLaw law{std::make_shared<AttitudeLaw>(InertialLaw{}), 0.01, 60, 7};
  const auto ready = Attitude::make(law, context), again = Attitude::make(law, context);
  double sum = 0;
  const int count = 20000;
  for (int k = 0; k < count; ++k) {
    const auto r = *ready->at(at(3.7 * k));
    EXPECT_EQ(r.row(0).y, again->at(at(3.7 * k))->row(0).y);
    // Small turn about each axis: off-diagonal elements.
    sum += std::pow(0.5 * (r.row(0).y - r.row(1).x), 2);
  }
  EXPECT_NEAR(std::sqrt(sum / count), 0.01, 3e-4); // 1/sqrt of 1,200 periods
  EXPECT_FALSE(check_attitude(LibrationLaw{law.law, 0.01, 0, 7}));
}

TEST(AttitudeLaws, AimsAtAPlaceOnTheEarth) {
  const Site site = *make_site("maui", 20.7083, -156.2578, 3058);
  TwoAxisLaw law;
  law.at = GroundTarget{site};
  const AttitudeContext now = at(100);
  const auto ready = Attitude::make(law, context);
  const Vec3<Gcrs> place = itrs_from_gcrs(now.time).inverse() * itrs_position_km(site);
  EXPECT_LT(norm(ready->at(now)->row(2) - normalized(place - now.position_km)), 1e-14);
}

TEST(AttitudeLaws, OffsetsTurnYawPitchRoll) {
  // Nadir mode: x along +y, y along -z, z along -x of GCRS. Yaw of 90 deg brings x to where y was.
  TwoAxisLaw law;
  law.offset.yaw_rad = pi / 2;
  const auto yawed = Attitude::make(law, context)->at(at(0));
  EXPECT_LT(norm(yawed->row(0) - Vec3<Gcrs>{0, 0, -1}), 1e-15);
  EXPECT_LT(norm(yawed->row(2) - Vec3<Gcrs>{-1, 0, 0}), 1e-15);
  law.offset = {0.1, 0, 0}; // roll alone: z turns towards -y
  const auto rolled = Attitude::make(law, context)->at(at(0));
  EXPECT_LT(norm(rolled->row(2) - Vec3<Gcrs>{-std::cos(0.1), 0, std::sin(0.1)}), 1e-15);
}

} // namespace
} // namespace umov
