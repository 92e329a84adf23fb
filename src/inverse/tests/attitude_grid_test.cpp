#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/quantity.h>
#include <umov/inverse/attitude_grid.h>

namespace umov {
namespace {

TEST(AttitudeGrid, CoversAllAttitudesEvenly) {
  const auto grid = attitude_grid(4000);
  // The mean of all rotation matrices over SO(3) is 0; random ones would leave 0.009 (1 sigma).
  std::array<double, 9> mean{};
  for (const Quaternion &q : grid) {
    EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-12);
    const auto r = rotation_from<Body, Gcrs>(q);
    for (int k = 0; k < 3; ++k) {
      mean[static_cast<std::size_t>(3 * k)] += r.row(k).x / 4000;
      mean[static_cast<std::size_t>(3 * k + 1)] += r.row(k).y / 4000;
      mean[static_cast<std::size_t>(3 * k + 2)] += r.row(k).z / 4000;
    }
  }
  for (const double m : mean)
    EXPECT_NEAR(m, 0, 0.005);
  // No hole: every cell of a coarser grid has a neighbour within one spacing.
  for (const Quaternion &q : attitude_grid(500)) {
    double nearest = pi;
    for (const Quaternion &other : grid)
      nearest = std::min(nearest, angle_between(q, other));
    EXPECT_LT(nearest, grid_spacing_rad(4000));
  }
}

TEST(AttitudeGrid, TurnsAreThoseOfTheBodyAboutItsOwnAxes) {
  // A body turned by 30 deg about its +Z sees a fixed direction turned by -30 deg.
  const Quaternion q = turned({}, {0, 0, pi / 6});
  const Vec3<Body> seen = rotation_from<Body, Gcrs>(q) * Vec3<Gcrs>{1, 0, 0};
  EXPECT_NEAR(seen.x, std::cos(pi / 6), 1e-12);
  EXPECT_NEAR(seen.y, -0.5, 1e-12);
  const Quaternion from = turned({}, {0.3, -1.1, 0.7});
  const Vec3<Body> turn{-0.4, 0.2, 1.3};
  const Vec3<Body> back = turn_between(from, turned(from, turn));
  EXPECT_NEAR(back.x, turn.x, 1e-12);
  EXPECT_NEAR(back.y, turn.y, 1e-12);
  EXPECT_NEAR(back.z, turn.z, 1e-12);
  EXPECT_NEAR(angle_between({1, 0, 0, 0}, {-1, 0, 0, 0}), 0, 1e-12); // both signs are one
}

TEST(AttitudeGrid, BallsHaveTheirVolume) {
  EXPECT_NEAR(share_within(pi), 1, 1e-12);
  // A small ball: 4/3 pi r^3 over 8 pi^2.
  EXPECT_NEAR(share_within(0.01) / (4.0 / 3 * pi * 1e-6 / (8 * pi * pi)), 1, 1e-4);
}

} // namespace
} // namespace umov
