#include <cmath>
#include <gtest/gtest.h>
#include <umov/optics/fresnel.h>

namespace umov {
namespace {

constexpr double degree = pi / 180;

TEST(Mueller, MatchesThePrintedEntriesAtPhase140) {
  // physics page, section 2: M00, M01, M22, M23 at incidence 70 deg, six digits.
  const struct {
    std::complex<double> eta;
    double m[4];
  } rows[] = {{{1.62, 1.94}, {.461325, .271697, .002181, .372823}},
              {{.359, 2.69}, {.846273, .099574, -.088388, .835733}},
              {{.170, 3.14}, {.934640, .045093, -.219885, .907287}},
              {{.556, 5.146}, {.899382, .074026, -.550021, .707733}},
              {{1.015, 6.627}, {.883108, .087379, -.658676, .581715}},
              {{1.558, 7.712}, {.867051, .099824, -.700456, .501174}}};
  for (const auto &row : rows) {
    const auto m = fresnel_mueller(std::cos(70 * degree), row.eta).m;
    EXPECT_NEAR(m[0][0], row.m[0], 5.1e-7);
    EXPECT_NEAR(m[0][1], row.m[1], 5.1e-7);
    EXPECT_NEAR(m[2][2], row.m[2], 5.1e-7);
    EXPECT_NEAR(m[2][3], row.m[3], 5.1e-7);
    EXPECT_EQ(m[3][2], -m[2][3]);
  }
}

TEST(Mueller, TurnsDiagonalLightAsPrinted) {
  // physics page, section 2: Au 425, (1, 0, 1, 0) in.
  const Stokes<ScatteringPlane> out =
      fresnel_mueller(std::cos(70 * degree), {1.62, 1.94}) * Stokes<ScatteringPlane>{1, 0, 1, 0};
  EXPECT_NEAR(out.i, .461325, 5.1e-7);
  EXPECT_NEAR(out.q, .271697, 5.1e-7);
  EXPECT_NEAR(out.u, .002181, 5.1e-7);
  EXPECT_NEAR(out.v, -.372823, 5.1e-7);
}

TEST(Fresnel, NormalGrazingBrewsterAndNoInterface) {
  const auto normal = fresnel_amplitudes(1, {1.5, 0});
  EXPECT_NEAR(normal.s.real(), -0.2, 1e-15); // (1-n)/(1+n), field kept: phase jump of pi
  EXPECT_NEAR(normal.p.real(), 0.2, 1e-15);  // the other sign: p turns with k
  for (const std::complex<double> eta : {std::complex<double>(1.5, 0), {0.3, 3.0}}) {
    const auto grazing = fresnel_amplitudes(0, eta);
    EXPECT_NEAR(std::abs(grazing.s), 1, 1e-15);
    EXPECT_NEAR(std::abs(grazing.p), 1, 1e-15);
  }
  EXPECT_NEAR(std::abs(fresnel_amplitudes(std::cos(std::atan(1.5)), {1.5, 0}).p), 0, 1e-15);
  for (const double c : {0.0, 1e-300, 0.3, 1.0}) {
    EXPECT_EQ(std::abs(fresnel_amplitudes(c, {1, 0}).s), 0);
    EXPECT_EQ(std::abs(fresnel_amplitudes(c, {1, 0}).p), 0);
  }
  // k -> 0 is continuous.
  EXPECT_LT(
      std::abs(fresnel_amplitudes(0.4, {1.5, 1e-300}).s - fresnel_amplitudes(0.4, {1.5, 0}).s),
      1e-299);
}

TEST(Fresnel, QuarterWaveRetardanceAtThePrincipalAngle) {
  // physics page, section 2: M22 = 0 there, six digits of the angle.
  const struct {
    std::complex<double> eta;
    double phase;
  } rows[] = {{{1.62, 1.94}, 139.843},  {{.359, 2.69}, 143.394},   {{.170, 3.14}, 147.442},
              {{.556, 5.146}, 158.854}, {{1.015, 6.627}, 163.378}, {{1.558, 7.712}, 165.727}};
  for (const auto &row : rows) {
    const auto at = [&](double phase) {
      return fresnel_mueller(std::cos(phase / 2 * degree), row.eta).m[2][2];
    };
    EXPECT_LT(at(row.phase - 6e-4) * at(row.phase + 6e-4), 0); // the sign changes inside the digit
  }
}

} // namespace
} // namespace umov
