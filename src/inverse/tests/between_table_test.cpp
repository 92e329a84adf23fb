#include <umov/inverse/between_table.h>

#include <atomic>
#include <cmath>
#include <gtest/gtest.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

/// Light between surfaces as a formula that keeps reciprocity: I and Q are even in the two
/// directions, U is odd.
Stokes<ScatteringPlane> formula(const Pose &pose) {
  const Vec3<Body> m = pose.sun + pose.observer;
  const double i = 2 + m.x + 0.5 * m.y * m.z;
  return {i, 0.2 * i * m.z, 0.1 * (pose.sun.x - pose.observer.x), 0};
}

struct Whole {
  std::atomic<std::size_t> asked = 0;
  bool is_stopped = false;
  PoseLighting lighting() {
    return [this](std::span<const Pose> poses, StokesTable &out) {
      asked += poses.size();
      out.resize(poses.size(), 2);
      out.indirect.resize(2 * poses.size());
      for (std::size_t k = 0; k < poses.size(); ++k)
        for (std::size_t b = 0; b < 2; ++b)
          out.indirect[2 * k + b] = formula(poses[k]) * (b == 0 ? 1.0 : 3.0);
      return !is_stopped;
    };
  }
};

/// Direct light of two bands, and of one part: `blocks` of them.
StokesTable dark(std::size_t poses, std::size_t bands) {
  StokesTable out;
  out.resize(poses, bands);
  return out;
}

std::vector<Pose> poses_of(std::uint64_t seed, std::size_t count) {
  std::vector<Pose> out;
  for (std::uint64_t k = 0; k < count; ++k)
    out.push_back(random_pose(seed, k, Angle::degrees(20 + 0.7 * static_cast<double>(k % 180))));
  return out;
}

TEST(BetweenTable, IsLinearBetweenNodesThatAreLitOnce) {
  Whole whole;
  BetweenTable table(36, 0, true);
  const std::vector<Pose> poses = poses_of(1, 300);
  StokesTable found = dark(300, 4);
  ASSERT_TRUE(table.add_to(found, poses, whole.lighting(), 2));
  EXPECT_EQ(table.lit(), whole.asked);
  EXPECT_LE(table.lit(), 16u * 300);
  for (std::size_t k = 0; k < 300; ++k) {
    const Stokes<ScatteringPlane> s = formula(poses[k]);
    for (std::size_t b = 0; b < 2; ++b) {
      const double times = b == 0 ? 1 : 3;
      // Cells of 5 deg (.09 rad, half as much again where the octahedron is stretched): a direction
      // leaves its chord by up to .13^2/8.
      EXPECT_NEAR(found.i[4 * k + b], times * s.i, times * 0.02);
      EXPECT_NEAR(found.q[4 * k + b], times * s.q, times * 0.02);
      EXPECT_NEAR(found.u[4 * k + b], times * s.u, times * 0.002);
      EXPECT_NEAR(found.i_err[4 * k + b], 0.1 * found.i[4 * k + b], 1e-9);
      EXPECT_EQ(found.i[4 * k + 2 + b], 0); // a part of direct light stays as it is
    }
  }
  const std::size_t before = whole.asked;
  StokesTable again = dark(300, 4);
  ASSERT_TRUE(table.add_to(again, poses, whole.lighting(), 1));
  EXPECT_EQ(whole.asked, before);
  EXPECT_EQ(again.i, found.i);
}

TEST(BetweenTable, SunAndObserverSwappedAreTheSameNodes) {
  Whole whole;
  BetweenTable table(20, 0, true);
  std::vector<Pose> poses = poses_of(2, 50);
  StokesTable found = dark(50, 2), swapped = dark(50, 2);
  ASSERT_TRUE(table.add_to(found, poses, whole.lighting(), 1));
  const std::size_t lit = table.lit();
  for (Pose &pose : poses)
    std::swap(pose.sun, pose.observer);
  ASSERT_TRUE(table.add_to(swapped, poses, whole.lighting(), 1));
  EXPECT_EQ(table.lit(), lit);
  for (std::size_t k = 0; k < found.i.size(); ++k) {
    EXPECT_NEAR(swapped.i[k], found.i[k], 1e-12); // sums in another order
    EXPECT_NEAR(swapped.q[k], found.q[k], 1e-12);
    EXPECT_NEAR(swapped.u[k], -found.u[k], 1e-12);
  }
  // Parts that turn after the Sun make another body of a swapped pose.
  BetweenTable each(20, 0, false);
  ASSERT_TRUE(each.add_to(found, poses, whole.lighting(), 1));
  const std::size_t one_way = each.lit();
  for (Pose &pose : poses)
    std::swap(pose.sun, pose.observer);
  ASSERT_TRUE(each.add_to(found, poses, whole.lighting(), 1));
  EXPECT_GT(each.lit(), one_way * 19 / 10); // a few cells lie on both sides
}

/// Light of a list may be shared by poses that follow each other closely: none do.
TEST(BetweenTable, NeighboursAreNotLitOneAfterTheOther) {
  double closest = INFINITY;
  const PoseLighting look = [&](std::span<const Pose> poses, StokesTable &out) {
    for (std::size_t k = 1; k < poses.size(); ++k)
      closest = std::min(closest, angle_between(poses[k - 1].sun, poses[k].sun) +
                                      angle_between(poses[k - 1].observer, poses[k].observer));
    out.resize(poses.size(), 2);
    return true; // and no light between surfaces
  };
  BetweenTable table(36, 0, true);
  const std::vector<Pose> poses = poses_of(3, 40);
  StokesTable found = dark(40, 2);
  ASSERT_TRUE(table.add_to(found, poses, look, 1));
  EXPECT_GE(closest, 0.5); // rad: reach of what a series shares (docs/theory/bounces.md)
  EXPECT_EQ(found.i, dark(40, 2).i);
}

TEST(BetweenTable, WhatWasStoppedIsAskedForAgain) {
  Whole whole;
  whole.is_stopped = true;
  BetweenTable table(12, 0, true);
  const std::vector<Pose> poses = poses_of(4, 10);
  StokesTable found = dark(10, 2);
  EXPECT_FALSE(table.add_to(found, poses, whole.lighting(), 1));
  EXPECT_EQ(table.lit(), 0u);
  EXPECT_EQ(found.i, dark(10, 2).i);
  whole.is_stopped = false;
  EXPECT_TRUE(table.add_to(found, poses, whole.lighting(), 1));
  EXPECT_GT(found.i[0], 0);
}

} // namespace
} // namespace umov
