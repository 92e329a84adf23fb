#include <umov/inverse/between_table.h>

#include <atomic>
#include <cmath>
#include <gtest/gtest.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

/// Light between surfaces that is polarized along a line of the body as the observer sees it, by as
/// much as that line is long there: smooth in both directions, whatever the scattering plane does.
Stokes<ScatteringPlane> formula(const Pose &pose) {
  const Vec3<Body> line = normalized(Vec3<Body>{0.3, 0.5, 0.8}), &k = pose.observer;
  const double i = 2 + pose.sun.x + 0.5 * pose.sun.y * k.z;
  const Vec3<Body> seen = line - k * dot(line, k), s = normalized(cross(k, pose.sun));
  const double along = dot(seen, s), across = dot(seen, cross(k, s));
  return {i, 0.3 * i * (along * along - across * across), 0.6 * i * along * across, 0};
}

struct Whole {
  std::atomic<std::size_t> asked = 0;
  std::atomic<bool> is_alone = true, is_stopped = false;
  BetweenTable::Lighting lighting(unsigned threads) {
    return {[this](std::span<const Pose> poses, StokesTable &out) {
              asked += poses.size();
              is_alone = is_alone && poses.size() == 1;
              out.resize(poses.size(), 2);
              out.indirect.resize(2 * poses.size());
              for (std::size_t k = 0; k < poses.size(); ++k)
                for (std::size_t b = 0; b < 2; ++b)
                  out.indirect[2 * k + b] = formula(poses[k]) * (b == 0 ? 1.0 : 3.0);
              return !is_stopped;
            },
            {},
            threads};
  }
};

StokesTable dark(std::size_t poses, std::size_t bands) {
  StokesTable out;
  out.resize(poses, bands);
  return out;
}

/// Phase angles of 3 to 177 deg.
std::vector<Pose> poses_of(std::uint64_t seed, std::size_t count) {
  std::vector<Pose> out;
  for (std::uint64_t k = 0; k < count; ++k)
    out.push_back(random_pose(seed, k, Angle::degrees(3 + 0.58 * static_cast<double>(k % 300))));
  return out;
}

TEST(BetweenTable, IsLinearBetweenNodesAndStandsInTheBody) {
  Whole whole;
  BetweenTable table(36, 0);
  const std::vector<Pose> poses = poses_of(1, 300);
  StokesTable found = dark(300, 4); // of two bands and a part of them
  ASSERT_TRUE(table.add_to(found, poses, whole.lighting(2)));
  for (std::size_t k = 0; k < 300; ++k) {
    const Stokes<ScatteringPlane> s = formula(poses[k]);
    for (std::size_t b = 0; b < 2; ++b) {
      const double times = b == 0 ? 1 : 3;
      // Cells of 5 deg (.09 rad, half as much again where the octahedron is stretched): a direction
      // leaves its chord by up to .13^2/8, I of up to 3.3 and its Q and U by a few times that.
      EXPECT_NEAR(found.i[4 * k + b], times * s.i, times * 0.02);
      EXPECT_NEAR(found.q[4 * k + b], times * s.q, times * 0.02);
      EXPECT_NEAR(found.u[4 * k + b], times * s.u, times * 0.02);
      EXPECT_NEAR(found.i_err[4 * k + b], 0.1 * found.i[4 * k + b], 1e-9);
      EXPECT_EQ(found.i[4 * k + 2 + b], 0); // a part of direct light stays as it is
    }
  }
}

TEST(BetweenTable, ANodeIsLitOnceAndByItself) {
  Whole whole;
  BetweenTable table(24, 0), other(24, 0);
  const std::vector<Pose> poses = poses_of(2, 200);
  StokesTable found = dark(200, 2), again = dark(200, 2), reversed = dark(100, 2);
  ASSERT_TRUE(table.add_to(found, poses, whole.lighting(2)));
  EXPECT_EQ(table.lit(), whole.asked);
  const std::size_t before = whole.asked;
  ASSERT_TRUE(table.add_to(again, poses, whole.lighting(1)));
  EXPECT_EQ(whole.asked, before);
  EXPECT_EQ(again.i, found.i);
  // The same numbers where others were asked first.
  ASSERT_TRUE(other.add_to(reversed, std::span(poses).last(100), whole.lighting(1)));
  StokesTable then = dark(200, 2);
  ASSERT_TRUE(other.add_to(then, poses, whole.lighting(1)));
  EXPECT_EQ(then.i, found.i);
  EXPECT_EQ(then.q, found.q);
  EXPECT_EQ(then.u, found.u);
  EXPECT_TRUE(whole.is_alone);
}

TEST(BetweenTable, SunAndObserverSwappedAreOtherNodes) {
  Whole whole;
  BetweenTable table(24, 0);
  std::vector<Pose> poses = poses_of(3, 100);
  StokesTable found = dark(100, 2);
  ASSERT_TRUE(table.add_to(found, poses, whole.lighting(1)));
  for (Pose &pose : poses)
    std::swap(pose.sun, pose.observer);
  StokesTable swapped = dark(100, 2);
  ASSERT_TRUE(table.add_to(swapped, poses, whole.lighting(1)));
  for (std::size_t k = 0; k < 100; ++k)
    EXPECT_NEAR(swapped.q[2 * k], formula(poses[k]).q, 0.05); // cells of 7.5 deg
}

TEST(BetweenTable, WithoutAPlaneThereIsIntensityAlone) {
  Whole whole;
  BetweenTable table(24, 0);
  const Vec3<Body> v = normalized(Vec3<Body>{0.2, -0.4, 0.7});
  const std::vector<Pose> poses{{v, v, 0}};
  StokesTable found = dark(1, 2);
  ASSERT_TRUE(table.add_to(found, poses, whole.lighting(1)));
  EXPECT_NEAR(found.i[0], 2 + v.x + 0.5 * v.y * v.z, 0.02);
  EXPECT_EQ(found.q[0], 0);
  EXPECT_EQ(found.u[0], 0);
}

TEST(BetweenTable, WhatWasStoppedIsAskedForAgain) {
  Whole whole;
  whole.is_stopped = true;
  BetweenTable table(12, 0);
  const std::vector<Pose> poses = poses_of(4, 10);
  StokesTable found = dark(10, 2);
  EXPECT_FALSE(table.add_to(found, poses, whole.lighting(1)));
  EXPECT_EQ(table.lit(), 0u);
  EXPECT_EQ(found.i, dark(10, 2).i);
  whole.is_stopped = false;
  EXPECT_TRUE(table.add_to(found, poses, whole.lighting(1)));
  EXPECT_GT(found.i[0], 0);
}

} // namespace
} // namespace umov
