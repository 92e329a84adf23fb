#include "inverse/tests/box_light.h"

#include <umov/inverse/contributions.h>

namespace umov {
namespace {

using Measured = CurveLikelihood::Measured;

const Turning true_turning{{0.5, 0.7, -0.1, 0.5}, {}};

/// An answer that is the truth.
PoseAnswer true_answer() {
  PoseAnswer out;
  out.modes.emplace_back().turning = true_turning;
  out.errors = no_floor();
  out.errors.zero_point_sd = 1e-6;
  return out;
}

TEST(Contributions, AddUpToAllNumbersAllChiSquareAndAllThatIsKnown) {
  ObservedCurve curve = pass(40);
  observe(curve, Box(), true_turning, 50, 3);
  const CurveModel model(curve, Box(), {0, 1});
  const PoseAnswer answer = true_answer();
  const auto all = contributions_to(answer, model, 1);
  ASSERT_EQ(all.size(), 4u); // I, and q and u, of two bands
  std::size_t numbers = 0;
  double chi2 = 0, share = 0;
  for (const Contribution &one : all) {
    numbers += one.numbers;
    chi2 += one.chi2;
    share += one.share;
    EXPECT_GT(one.share, 0);
  }
  EXPECT_EQ(numbers, 6u * 40u);
  EXPECT_NEAR(share, 1, 1e-3); // what zero points of 1e-6 hold is left
  EXPECT_NEAR(chi2, 240, 5 * std::sqrt(2 * 240.));
  EXPECT_EQ(all[0].what, Measured::Intensity);
  EXPECT_EQ(all[1].what, Measured::Polarization);
}

TEST(Contributions, BandsThatAreAlikeGiveAlikeAndWhatIsHardlyMeasuredNothing) {
  const Box plain(true); // both bands have one light
  ObservedCurve curve = pass(40);
  observe(curve, plain, true_turning, 50, 4);
  for (ObservedSample &s : curve.samples) {
    s.i_sd = 0.02; // errors that no noise tells apart
    s.cov_qq = s.cov_uu = s.band == 0 ? 4e-4 : 1e4;
  }
  const CurveModel model(curve, plain, {0, 1});
  const auto all = contributions_to(true_answer(), model, 1);
  ASSERT_EQ(all.size(), 4u);
  EXPECT_NEAR(all[0].share, all[2].share, 0.01); // I of both; their scales are fitted to the noise
  // As their weights, 4e-4 / 1e4; what no number is taken for better than adds 1e-8 to the one.
  EXPECT_NEAR(all[3].share / all[1].share, 4e-8, 1e-11);
}

TEST(Contributions, OfNoModeThereAreNone) {
  ObservedCurve curve = pass(4);
  observe(curve, Box(), true_turning, 50, 3);
  EXPECT_TRUE(contributions_to(PoseAnswer(), CurveModel(curve, Box(), {0, 1}), 1).empty());
}

} // namespace
} // namespace umov
