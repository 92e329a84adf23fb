#include "core/tests/anchors.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/optics/fresnel.h>

namespace umov {
namespace {

constexpr double degree = pi / 180;

TEST(Mueller, MatchesThePrintedEntriesAtPhase140) {
  for (const AnchorRow &row : Anchors("mueller")) { // incidence 70 deg, six digits
    const auto m = fresnel_mueller(std::cos(70 * degree), {row["n"], row["k"]}).m;
    EXPECT_NEAR(m[0][0], row["m00"], 5.1e-7);
    EXPECT_NEAR(m[0][1], row["m01"], 5.1e-7);
    EXPECT_NEAR(m[2][2], row["m22"], 5.1e-7);
    EXPECT_NEAR(m[2][3], row["m23"], 5.1e-7);
    EXPECT_EQ(m[3][2], -m[2][3]);
  }
}

TEST(Mueller, TurnsDiagonalLightAsPrinted) {
  // Au 425, (1, 0, 1, 0) in: the first and third columns of the matrix, six digits.
  const Anchors table("mueller");
  const AnchorRow &gold = table.row({"paper_au", "425"});
  const Stokes<ScatteringPlane> out =
      fresnel_mueller(std::cos(70 * degree), {1.62, 1.94}) * Stokes<ScatteringPlane>{1, 0, 1, 0};
  EXPECT_NEAR(out.i, gold["m00"], 5.1e-7);
  EXPECT_NEAR(out.q, gold["m01"], 5.1e-7);
  EXPECT_NEAR(out.u, gold["m22"], 5.1e-7);
  EXPECT_NEAR(out.v, -gold["m23"], 5.1e-7);
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
  for (const AnchorRow &row : Anchors("principal_angle")) { // M22 = 0 there
    const auto at = [&](double phase) {
      return fresnel_mueller(std::cos(phase / 2 * degree), {row["n"], row["k"]}).m[2][2];
    };
    const double phase = row["phase_deg"];
    EXPECT_LT(at(phase - 6e-4) * at(phase + 6e-4), 0); // the sign changes inside the last digit
  }
}

} // namespace
} // namespace umov
