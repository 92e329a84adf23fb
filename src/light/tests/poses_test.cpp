#include <cmath>
#include <gtest/gtest.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

TEST(RandomPose, KeepsThePhaseAngleAndIsUniformOverTheSphere) {
  constexpr int count = 20000;
  Vec3<Body> mean{};
  double zz = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const Pose pose = random_pose(3, i, Angle::degrees(140));
    EXPECT_NEAR(angle_between(pose.sun, pose.observer) * 180 / pi, 140, 1e-10);
    mean += pose.observer / count;
    zz += pose.observer.z * pose.observer.z / count;
  }
  // Uniform: mean 0 with standard error sqrt(1/3/count) = .0041, <z^2> = 1/3 with .0021; 4 sigma.
  EXPECT_LT(norm(mean), 4 * std::sqrt(1.0 / count));
  EXPECT_NEAR(zz, 1.0 / 3, 4 * 0.0021);
}

TEST(RandomPose, DependsOnSeedAndIndexAlone) {
  const Pose a = random_pose(3, 17, Angle::degrees(60));
  random_pose(3, 18, Angle::degrees(60));
  const Pose b = random_pose(3, 17, Angle::degrees(60));
  EXPECT_TRUE(a.sun == b.sun && a.observer == b.observer);
  EXPECT_FALSE(a.sun == random_pose(4, 17, Angle::degrees(60)).sun);
}

} // namespace
} // namespace umov
