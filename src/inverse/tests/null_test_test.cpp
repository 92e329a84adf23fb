#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/quantity.h>
#include <umov/core/random.h>
#include <umov/inverse/null_test.h>
#include <utility>

namespace umov {
namespace {

/// Measurements of u_scat with an error of 1.4 % (SNR 100 in I), while the plane turns by so many
/// degrees.
ObservedCurve polarized_pass(double q0, double u0, std::uint64_t seed, std::size_t count = 120,
                             double turn_deg = 100) {
  ObservedCurve out;
  out.bands = {"a"};
  for (std::size_t k = 0; k < count; ++k) {
    ObservedEpoch e;
    e.scattering_axis_rad =
        static_cast<double>(k) * turn_deg / static_cast<double>(count) * pi / 180;
    out.epochs.push_back(e);
    ObservedSample s;
    s.epoch = k;
    const auto r = uniform4(seed, 1, k);
    const double noise = std::sqrt(-2 * std::log(r[0])) * std::cos(2 * pi * r[1]);
    const double twice = 2 * e.scattering_axis_rad;
    s.q = 0;
    s.u = u0 * std::cos(twice) - q0 * std::sin(twice) + 0.0141 * noise;
    s.cov_uu = s.cov_qq = 0.0141 * 0.0141;
    out.samples.push_back(s);
  }
  return out;
}

TEST(NullTest, InstrumentalPolarizationRaisesTheFlagAndACleanPassDoesNot) {
  int clean = 0, dirty = 0;
  constexpr int passes = 1000;
  double mean = 0;
  for (std::uint64_t seed = 0; seed < passes; ++seed) {
    clean += null_test(polarized_pass(0, 0, seed)).is_flagged() ? 1 : 0;
    const NullTest found = null_test(polarized_pass(0.01, 0, seed));
    dirty += found.is_flagged() ? 1 : 0;
    mean += found.q0 / passes;
  }
  // 1 in 100 by construction: 10 +- 3.2; 5 sigma.
  EXPECT_LE(clean, 26);
  EXPECT_GE(dirty, 980);           // five sigma of the mean
  EXPECT_NEAR(mean, 0.01, 0.0005); // its own error is 6e-5
}

TEST(NullTest, HalfAPerCentTakesThreeTimesAsManyNumbers) {
  // Over half a turn of the plane the gain is a chi-square of two degrees of freedom with the
  // non-centrality n (.005/.0141)^2 / 2: beyond 9.21 in 45 % of passes of 120 numbers, 97 % of 360
  // (40,000 draws of two normal numbers). No better test of a constant is to be had.
  constexpr int passes = 1000;
  for (const auto &[count, share] :
       {std::pair{std::size_t{120}, 0.452}, {std::size_t{360}, 0.966}}) {
    int flagged = 0;
    for (std::uint64_t seed = 0; seed < passes; ++seed)
      flagged += null_test(polarized_pass(0.005, 0, 7000 + seed, count, 180)).is_flagged() ? 1 : 0;
    EXPECT_NEAR(flagged / 1000.0, share, 4 * std::sqrt(share * (1 - share) / passes));
  }
}

TEST(NullTest, APlaneThatStaysTellsOnlyOneOfThem) {
  ObservedCurve curve = polarized_pass(0, 0, 1);
  for (ObservedEpoch &e : curve.epochs)
    e.scattering_axis_rad = 0.3;
  EXPECT_FALSE(null_test(curve).is_flagged());
  EXPECT_EQ(null_test(curve).q0_sd, 0);
}

} // namespace
} // namespace umov
