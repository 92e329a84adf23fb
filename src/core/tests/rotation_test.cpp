#include <gtest/gtest.h>
#include <umov/core/random.h>
#include <umov/core/rotation.h>

namespace umov {
namespace {

TEST(Rotation, QuarterTurnAboutZTakesFrameXToMinusY) {
  // body_from_gcrs with the body turned by +90 deg about z: the GCRS x axis is the body's -y.
  const double h = std::sqrt(0.5);
  const auto body_from_gcrs = rotation_from<Body, Gcrs>({h, 0, 0, h});
  const Vec3<Body> v = body_from_gcrs * Vec3<Gcrs>{1, 0, 0};
  EXPECT_NEAR(v.x, 0, 1e-15);
  EXPECT_NEAR(v.y, -1, 1e-15);
}

TEST(Rotation, InverseUndoesAndNeighboursCancel) {
  const auto a = rotation_from<Body, Gcrs>({0.5, 0.5, -0.5, 0.5});
  const Vec3<Gcrs> v{0.1, -0.7, 0.3};
  const Vec3<Gcrs> back = (a.inverse() * a) * v;
  EXPECT_NEAR(norm(back - v), 0, 1e-15);
}

TEST(Rotation, QuaternionRoundTripAndSign) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto u = uniform4(1, 2, i);
    Quaternion q{u[0] - 0.5, u[1] - 0.5, u[2] - 0.5, u[3] - 0.5};
    const double n = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    q = {q.w / n, q.x / n, q.y / n, q.z / n};
    const Quaternion p = quaternion_from(rotation_from<Body, Gcrs>(q));
    const double sign = q.w < 0 ? -1 : 1;
    EXPECT_NEAR(p.w, sign * q.w, 1e-14);
    EXPECT_NEAR(p.x, sign * q.x, 1e-14);
    EXPECT_NEAR(p.y, sign * q.y, 1e-14);
    EXPECT_NEAR(p.z, sign * q.z, 1e-14);
  }
}

} // namespace
} // namespace umov
