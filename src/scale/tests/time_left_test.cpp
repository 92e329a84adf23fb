// How long the rest takes, by arithmetic of a job whose shards take what they take.

#include "scale/time_left.h"

#include <gtest/gtest.h>

namespace umov::scale {
namespace {

TEST(TimeLefts, AreWhatWasPredictedUntilAShardIsDone) {
  const TimeLeft clock(0.1, 3); // 10 s a shard of 100, 3 s before
  const std::vector<std::size_t> in_hand{100, 100};
  EXPECT_NEAR(clock.left_s(1000, in_hand, std::vector<double>{0, 0}), 53, 1e-9);
  EXPECT_NEAR(clock.left_s(1000, in_hand, std::vector<double>{5, 5}), 48, 1e-9);
  // 13 s were predicted for the first: who is at it for 26 has half of the machine at most, and all
  // takes twice as long: (200 + 2 6 - 26 - 20) / 2.
  EXPECT_NEAR(clock.left_s(1000, in_hand, std::vector<double>{26, 20}), 83, 1e-9);
}

TEST(TimeLefts, FollowWhatShardsTakeLately) {
  TimeLeft clock(1, 0);
  for (int k = 0; k < 4; ++k)
    clock.took(100, 50); // they learn
  for (int k = 0; k < 4; ++k)
    clock.took(100, 10);
  // Two workers, ten shards of which each has done half of one: (10 - 1) 10 s / 2.
  EXPECT_NEAR(clock.left_s(1000, std::vector<std::size_t>{100, 100}, std::vector<double>{5, 5}), 45,
              1e-9);
}

TEST(TimeLefts, LeaveOutFirstShardsThatLearnMuch) {
  TimeLeft masks(0.1, 30), rays(0.1, 0.5);
  for (TimeLeft *clock : {&masks, &rays})
    clock->took(100, 50, true);
  const std::vector<std::size_t> in_hand{100};
  EXPECT_NEAR(rays.left_s(100, in_hand, std::vector<double>{0}), 50, 1e-9);
  // Masks are there, and nothing is known yet of what the others take: 200 times .1 s, by 50 s in
  // place of the 40 that the first one should have taken.
  EXPECT_NEAR(masks.left_s(200, in_hand, std::vector<double>{0}), 25, 1e-9);
  masks.took(100, 12);
  EXPECT_NEAR(masks.left_s(200, in_hand, std::vector<double>{0}), 24, 1e-9);
}

TEST(TimeLefts, EndWithTheLongestShardInHand) {
  TimeLeft clock(1, 0);
  clock.took(100, 10);
  EXPECT_NEAR(clock.left_s(110, std::vector<std::size_t>{100, 10}, std::vector<double>{1, 1}), 9,
              1e-9);
  // One that takes longer than the others has no time left that anybody could tell.
  EXPECT_NEAR(clock.left_s(100, std::vector<std::size_t>{100}, std::vector<double>{60}), 0, 1e-9);
}

} // namespace
} // namespace umov::scale
