#include <gtest/gtest.h>
#include <umov/optics/stokes.h>

namespace umov {
namespace {

TEST(Stokes, LightAlongTheNewAxisIsAllQ) {
  // Linear light at +30 deg from the old axis; a new axis there sees Q = 1, U = 0.
  const double c = std::cos(pi / 3), s = std::sin(pi / 3);
  const Stokes<SkyNorth> turned =
      rotate_to<SkyNorth>(Stokes<ScatteringPlane>{1, c, s, 0.1}, Angle::degrees(30));
  EXPECT_NEAR(turned.q, 1, 1e-15);
  EXPECT_NEAR(turned.u, 0, 1e-15);
  EXPECT_EQ(turned.v, 0.1);
}

TEST(Stokes, ScatteringToSkyTurnsByThePositionAngleOfS) {
  // docs/conventions.md, change of axes: (Q, U)_sky = (Q cos 2psi - U sin 2psi, Q sin 2psi + U cos
  // 2psi).
  const double psi = 0.7;
  const Stokes<SkyNorth> sky =
      rotate_to<SkyNorth>(Stokes<ScatteringPlane>{1, 0.4, 0.2, 0}, Angle::radians(-psi));
  EXPECT_NEAR(sky.q, 0.4 * std::cos(2 * psi) - 0.2 * std::sin(2 * psi), 1e-15);
  EXPECT_NEAR(sky.u, 0.4 * std::sin(2 * psi) + 0.2 * std::cos(2 * psi), 1e-15);
}

TEST(Stokes, MuellerMatricesChain) {
  Mueller<ScatteringPlane, ScatteringPlane> a, b;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      a.m[i][j] = static_cast<double>(i) - 0.3 * static_cast<double>(j);
      b.m[i][j] = static_cast<double>(i * j) + 0.1;
    }
  const Stokes<ScatteringPlane> s{1, 0.2, -0.3, 0.4};
  const auto one = (a * b) * s, two = a * (b * s);
  EXPECT_NEAR(one.v, two.v, 1e-12);
  EXPECT_NEAR(one.i, two.i, 1e-12);
}

} // namespace
} // namespace umov
