#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <umov/attitude/attitude.h>
#include <umov/core/quantity.h>

namespace umov {
namespace {

// Rounding of a few products of unit vectors.
constexpr double rounding = 1e-15;
// One second in two-part Julian dates is good to 1e-10 s; at the rates below to 1e-9 rad.
constexpr double phase_tolerance = 1e-9;

const Epoch<Utc> start_time{2458139.5, 0};
Epoch<Utc> seconds_later(double s) { return {2458139.5, s / 86400}; }

/// A circular orbit in the equator, at +x and moving towards +y; Sun and observer at angles.
AttitudeContext equatorial(Epoch<Utc> time = start_time) {
  return {time, {7000, 0, 0}, {0, 7.5, 0}, {0, 0.6, 0.8}, {-0.8, 0, 0.6}};
}

template <class F> void expect_near(Vec3<F> a, Vec3<F> b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

void expect_axes(const Rotation<Body, Gcrs> &r, Vec3<Gcrs> x, Vec3<Gcrs> y, Vec3<Gcrs> z,
                 double tolerance) {
  expect_near(r.row(0), x, tolerance);
  expect_near(r.row(1), y, tolerance);
  expect_near(r.row(2), z, tolerance);
}

Result<Rotation<Body, Gcrs>> asked(const AttitudeLaw &law, const AttitudeContext &now,
                                   const AttitudeContext &at_epoch) {
  UMOV_ASSIGN(ready, Attitude::make(law, [&](Epoch<Utc> time) -> Result<AttitudeContext> {
                AttitudeContext out = at_epoch;
                out.time = time;
                return out;
              }));
  return ready.at(now);
}

Rotation<Body, Gcrs> attitude(const AttitudeLaw &law, const AttitudeContext &now = equatorial(),
                              const AttitudeContext &at_epoch = equatorial()) {
  const auto r = asked(law, now, at_epoch);
  EXPECT_TRUE(r.has_value()) << (r ? "" : r.error().text());
  return r.value_or(Rotation<Body, Gcrs>{});
}

// --- two axes --------------------------------------------------------------------------------

TEST(TwoAxis, NadirModeInClosedForm) {
  // Z down (-x), X along the velocity (+y), so Y = Z x X is against the orbit normal (-z).
  expect_axes(attitude(TwoAxisLaw{}), {0, 1, 0}, {0, 0, -1}, {-1, 0, 0}, 0);
}

TEST(TwoAxis, IdentityWhenTheAxesStandAlongTheFrame) {
  const TwoAxisLaw law{
      {1, 0, 0}, CelestialDirection{0, 0}, {0, 0, 1}, CelestialDirection{0.3, pi / 2}};
  expect_axes(attitude(law), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, rounding);
}

TEST(TwoAxis, EachTargetIsPointedAt) {
  const struct {
    Target target;
    Vec3<Gcrs> direction;
  } rows[] = {{Target::Nadir, {-1, 0, 0}},   {Target::Zenith, {1, 0, 0}},
              {Target::Velocity, {0, 1, 0}}, {Target::OrbitNormal, {0, 0, 1}},
              {Target::Sun, {0, 0.6, 0.8}},  {Target::Observer, {-0.8, 0, 0.6}}};
  for (const auto &row : rows) {
    const TwoAxisLaw law{{0, 1, 0}, row.target, {1, 0, 0}, CelestialDirection{0.7, -0.4}};
    expect_near(attitude(law).row(1), row.direction, rounding);
  }
}

TEST(TwoAxis, RightAscensionRunsFromXTowardsY) {
  const TwoAxisLaw law{
      {0, 0, 1},
      CelestialDirection{Angle::degrees(90).radians(), Angle::degrees(30).radians()},
      {1, 0, 0},
      Target::Zenith};
  expect_near(attitude(law).row(2), {0, std::sqrt(0.75), 0.5}, rounding);
}

TEST(TwoAxis, PointsExactlyAndTurnsTheOtherAsNearAsPossible) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return CelestialDirection{pi * normal(random), std::atan(normal(random))};
  };
  const auto unit = [](CelestialDirection d) {
    const double c = std::cos(d.declination_rad);
    return Vec3<Gcrs>{c * std::cos(d.right_ascension_rad), c * std::sin(d.right_ascension_rad),
                      std::sin(d.declination_rad)};
  };
  for (int i = 0; i < 1000; ++i) {
    const Vec3<Body> point{normal(random), normal(random), normal(random)};
    const Vec3<Body> then{normal(random), normal(random), normal(random)};
    const CelestialDirection at = direction(), toward = direction();
    const auto r = attitude(TwoAxisLaw{point, at, then, toward});
    const Vec3<Body> p = normalized(point);
    expect_near(r * unit(at), p, rounding);
    // `toward` lies in the half plane of `point` and `then`.
    const Vec3<Body> t = r * unit(toward);
    const Vec3<Body> across = normalized(cross(p, then));
    EXPECT_NEAR(dot(t, across), 0, rounding);
    EXPECT_GT(dot(t - p * dot(p, t), then), 0);
    EXPECT_NEAR(dot(r.row(0), cross(r.row(1), r.row(2))), 1, 2 * rounding); // no mirror
  }
}

TEST(TwoAxis, StaysARotationWhenTheDirectionsAreNearlyParallel) {
  const TwoAxisLaw law{
      {0.6, 0, 0.8}, CelestialDirection{1, 0.2}, {1, 0, 0}, CelestialDirection{1 + 1e-8, 0.2}};
  const auto r = attitude(law);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(dot(r.row(i), r.row(j)), i == j ? 1 : 0, rounding);
}

TEST(TwoAxis, ParallelDirectionsAreAPhysicsError) {
  const TwoAxisLaw same{{0, 0, 1}, Target::Nadir, {1, 0, 0}, Target::Zenith};
  const auto r = asked(same, equatorial(), equatorial());
  ASSERT_FALSE(r.has_value());
  EXPECT_EQ(r.error().code, ErrorCode::Physics);
  EXPECT_EQ(r.error().message,
            "nadir and zenith are parallel at that time, expected two different directions; the "
            "turn about the pointed axis is free. Choose another \"toward\".");
  const TwoAxisLaw near{
      {0, 0, 1}, CelestialDirection{1, 0}, {1, 0, 0}, CelestialDirection{1 + 1e-10, 0}};
  EXPECT_FALSE(asked(near, equatorial(), equatorial()).has_value());
}

TEST(TwoAxis, TargetWithoutDirectionIsAPhysicsError) {
  AttitudeContext still = equatorial();
  still.velocity_km_s = {};
  const auto r = asked(TwoAxisLaw{}, still, still);
  ASSERT_FALSE(r.has_value());
  EXPECT_EQ(r.error().code, ErrorCode::Physics);
  EXPECT_TRUE(r.error().message.starts_with("velocity has no direction"));
}

// --- inertial --------------------------------------------------------------------------------

TEST(Inertial, QuarterTurnAboutZ) {
  // Body turned by +90 deg about z: its x axis points along +y.
  const double h = std::sqrt(0.5);
  expect_axes(attitude(InertialLaw{{h, 0, 0, h}}), {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, rounding);
}

TEST(Inertial, QAndMinusQAreTheSameAttitude) {
  const Quaternion q{0.5, -0.5, 0.1, 0.7};
  const double n = std::sqrt(0.25 + 0.25 + 0.01 + 0.49);
  const Quaternion plus{q.w / n, q.x / n, q.y / n, q.z / n};
  const Quaternion minus{-plus.w, -plus.x, -plus.y, -plus.z};
  const auto a = attitude(InertialLaw{plus}), b = attitude(InertialLaw{minus});
  for (int i = 0; i < 3; ++i)
    EXPECT_TRUE(a.row(i) == b.row(i)) << "same bits";
}

TEST(UnitQuaternion, NormalisesWhatIsNearAndRefusesTheRest) {
  const auto near = unit_quaternion({1 + 1e-9, 0, 0, 0});
  ASSERT_TRUE(near.has_value());
  EXPECT_EQ(near->w, 1);
  for (const Quaternion q :
       {Quaternion{1.001, 0, 0, 0}, Quaternion{0.999, 0, 0, 0}, Quaternion{0, 0, 0, 0},
        Quaternion{std::numeric_limits<double>::quiet_NaN(), 0, 0, 0}}) {
    const auto bad = unit_quaternion(q);
    ASSERT_FALSE(bad.has_value());
    EXPECT_EQ(bad.error().code, ErrorCode::BadInput);
    EXPECT_NE(bad.error().message.find("expected 1 within 1e-6"), std::string::npos);
  }
}

// --- spin ------------------------------------------------------------------------------------

SpinLaw quarter_per_second() { return {InertialLaw{}, {0, 0, 2}, pi / 2, start_time}; }

TEST(Spin, IsRightHandedAboutTheAxis) {
  const auto r = attitude(quarter_per_second(), equatorial(seconds_later(1)));
  expect_axes(r, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, phase_tolerance);
  SpinLaw back = quarter_per_second();
  back.rate_rad_s = -back.rate_rad_s;
  expect_axes(attitude(back, equatorial(seconds_later(1))), {0, -1, 0}, {1, 0, 0}, {0, 0, 1},
              phase_tolerance);
}

TEST(Spin, RunsBackwardsBeforeItsEpoch) {
  const auto r = attitude(quarter_per_second(), equatorial(seconds_later(-1)));
  expect_axes(r, {0, -1, 0}, {1, 0, 0}, {0, 0, 1}, phase_tolerance);
}

TEST(Spin, ReturnsAfterAWholeTurn) {
  const SpinLaw law{TwoAxisLaw{}, {1, 2, 3}, 2 * pi / 40, start_time};
  const auto before = attitude(TwoAxisLaw{});
  const auto after = attitude(law, equatorial(seconds_later(40)));
  expect_axes(after, before.row(0), before.row(1), before.row(2), phase_tolerance);
  const auto half = attitude(law, equatorial(seconds_later(20)));
  EXPECT_GT(norm(half.row(0) - before.row(0)), 0.1);
}

TEST(Spin, KeepsItsAxisAmongTheStars) {
  const SpinLaw law{TwoAxisLaw{}, {1, 2, 3}, 0.2, start_time};
  const Vec3<Body> axis = normalized(Vec3<Body>{1, 2, 3});
  const Vec3<Gcrs> sky = attitude(TwoAxisLaw{}).inverse() * axis;
  for (const double s : {0.5, 3.0, 77.0})
    expect_near(attitude(law, equatorial(seconds_later(s))) * sky, axis, 2 * rounding);
}

TEST(Spin, StartsFromTheAttitudeFrozenAtTheEpoch) {
  AttitudeContext later = equatorial(seconds_later(100));
  later.position_km = {0, 7000, 0}; // the object went on; the start must not follow it
  later.velocity_km_s = {-7.5, 0, 0};
  const auto r = attitude(SpinLaw{TwoAxisLaw{}, {0, 0, 1}, 0, start_time}, later, equatorial());
  expect_axes(r, {0, 1, 0}, {0, 0, -1}, {-1, 0, 0}, rounding);
}

// --- check -----------------------------------------------------------------------------------

TEST(CheckLaw, AcceptsTheDefaults) {
  EXPECT_TRUE(check_attitude(TwoAxisLaw{}).has_value());
  EXPECT_TRUE(check_attitude(InertialLaw{}).has_value());
  EXPECT_TRUE(check_attitude(quarter_per_second()).has_value());
}

TEST(CheckLaw, RefusesWithFoundExpectedAndHint) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SpinLaw endless = quarter_per_second();
  endless.rate_rad_s = std::numeric_limits<double>::infinity();
  SpinLaw no_axis = quarter_per_second();
  no_axis.axis = {};
  const struct {
    AttitudeLaw law;
    const char *piece;
  } rows[] = {
      {TwoAxisLaw{{0, 0, 1}, Target::Nadir, {0, 0, -2}, Target::Sun}, "are parallel"},
      {TwoAxisLaw{{0, 0, 0}, Target::Nadir, {1, 0, 0}, Target::Sun}, "\"point\" is (0, 0, 0)"},
      {TwoAxisLaw{{0, 0, 1}, Target::Nadir, {nan, 0, 0}, Target::Sun}, "\"then\" is (nan"},
      {TwoAxisLaw{{0, 0, 1}, CelestialDirection{0, 2}, {1, 0, 0}, Target::Sun},
       "declination of -90 to 90 deg"},
      {InertialLaw{{1.001, 0, 0, 0}}, "length 1.001"},
      {SpinLaw{InertialLaw{{0, 0, 0, 0}}, {0, 0, 1}, 1, start_time}, "length 0"},
      {no_axis, "\"axis\""},
      {endless, "spin rate"}};
  for (const auto &row : rows) {
    const auto r = check_attitude(row.law);
    ASSERT_FALSE(r.has_value()) << row.piece;
    EXPECT_EQ(r.error().code, ErrorCode::BadInput);
    EXPECT_NE(r.error().message.find(row.piece), std::string::npos) << r.error().message;
    EXPECT_NE(r.error().message.find("expected"), std::string::npos);
  }
}

} // namespace
} // namespace umov
