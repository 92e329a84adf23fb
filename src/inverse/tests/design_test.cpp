#include "box_light.h"

#include <umov/inverse/design.h>

namespace umov {
namespace {

/// Light of the box in an attitude, and an observer's errors.
Alternative boxed(const ObservedCurve &curve, const Turning &how, double snr) {
  std::vector<Pose> poses;
  for (const ObservedEpoch &e : curve.epochs)
    poses.push_back(pose_at(how, e));
  StokesTable table;
  EXPECT_TRUE(Box()(poses, table));
  Alternative out;
  for (std::size_t k = 0; k < poses.size() * 2; ++k) {
    const double i = table.i[k], sd = 0.6 / snr;
    out.light.i.push_back(i);
    out.light.q.push_back(table.q[k]);
    out.light.u.push_back(0);
    out.errors.i_sd.push_back(sd);
    out.errors.q_sd.push_back(i > 3 * sd ? std::sqrt(2.0) * sd / i : std::nan(""));
  }
  return out;
}

ObservedCurve layout_of(std::size_t epochs) {
  ObservedCurve out = pass(epochs);
  for (std::size_t e = 0; e < epochs; ++e)
    for (std::size_t b = 0; b < 2; ++b) {
      ObservedSample s;
      s.epoch = e;
      s.band = b;
      out.samples.push_back(s);
    }
  return out;
}

/// A few degrees apart, so that neither is sure.
std::vector<Alternative> three(const ObservedCurve &layout, double snr) {
  const Quaternion q = turned({}, Vec3<Body>{0.3, 0.2, -0.4});
  return {boxed(layout, {q, {}}, snr), boxed(layout, {turned(q, {0.05, 0, 0}), {}}, snr),
          boxed(layout, {turned(q, {0, 0.04, 0.04}), {}}, snr)};
}

/// Data of an alternative with noise.
ObservedCurve drawn(const ObservedCurve &layout, const Alternative &truth, std::uint64_t seed) {
  ObservedCurve out = expected_curve(layout, truth);
  std::uint64_t index = 0;
  for (ObservedSample &s : out.samples) {
    s.i += s.i_sd * noise(seed, index++);
    s.q += std::sqrt(s.cov_qq) * noise(seed, index++);
    s.u += std::sqrt(s.cov_uu) * noise(seed, index++);
  }
  return out;
}

TEST(Design, ExpectedLogBayesIsTheMeanOverSimulatedData) {
  const ObservedCurve layout = layout_of(12);
  const auto all = three(layout, 8);
  const auto expected = expected_log_bayes(layout, no_floor(), all);
  constexpr int trials = 1500;
  for (std::size_t truth = 0; truth < 3; ++truth)
    for (std::size_t other = 0; other < 3; ++other) {
      if (truth == other)
        continue;
      double mean = 0, square = 0;
      for (std::uint64_t seed = 0; seed < trials; ++seed) {
        const CurveLikelihood data(drawn(layout, all[truth], seed), no_floor());
        const auto value = [&](const Alternative &a) {
          return data.compare({a.light.i, a.light.q, a.light.u}).minus_2_log;
        };
        const double ratio = (value(all[other]) - value(all[truth])) / 2;
        mean += ratio / trials;
        square += ratio * ratio / trials;
      }
      const double d = expected[truth * 3 + other];
      ASSERT_GT(d, 0.3);
      // Four standard errors of the mean, and 0.1 for what zero points add to either side.
      EXPECT_NEAR(mean, d, 4 * std::sqrt((square - mean * mean) / trials) + 0.1);
      // A normal ratio of mean d has variance 2 d; 1500 draws tell it to 4 %.
      EXPECT_NEAR(square - mean * mean, 2 * d, 0.2 * 2 * d);
    }
}

TEST(Design, SharesOfRightAndSureAnswersAreThoseOfSimulatedData) {
  const ObservedCurve layout = layout_of(12);
  const auto all = three(layout, 8);
  const double prior[] = {1, 1, 1};
  const auto told = discrimination(expected_log_bayes(layout, no_floor(), all), prior, 1);
  constexpr int trials = 1500;
  double right = 0, decided = 0, bits = 0;
  for (std::size_t truth = 0; truth < 3; ++truth)
    for (std::uint64_t seed = 0; seed < trials; ++seed) {
      const CurveLikelihood data(drawn(layout, all[truth], 10'000 + seed), no_floor());
      double value[3], best = 1e300, sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const EndMember &light = all[k].light;
        value[k] = data.compare({light.i, light.q, light.u}).minus_2_log;
        best = std::min(best, value[k]);
      }
      for (const double v : value)
        sum += std::exp((best - v) / 2);
      const double own = std::exp((best - value[truth]) / 2) / sum;
      right += value[truth] == best ? 1. / (3 * trials) : 0;
      decided += own > 0.95 ? 1. / (3 * trials) : 0;
      bits += std::log2(3 * own) / (3 * trials);
    }
  EXPECT_GT(told.right, 0.5);
  EXPECT_LT(told.right, 0.99);
  // 4500 draws tell a share to 0.0075; three of that and one for the 4096 draws of the law.
  EXPECT_NEAR(told.right, right, 0.03);
  EXPECT_NEAR(told.decided, decided, 0.03);
  EXPECT_NEAR(told.information_bits, bits, 0.05);
}

/// Cumulative normal.
double phi(double x) { return std::erfc(-x / std::sqrt(2.0)) / 2; }

TEST(Design, TwoAlternativesAreTheTextbookCase) {
  const double prior[] = {1, 1};
  for (const double d : {0.01, 0.5, 2., 8., 50.}) {
    const double matrix[] = {0, d, d, 0};
    const Discrimination told = discrimination(matrix, prior, 1);
    // Two normals 2 sqrt(d/2) standard deviations apart (Van Trees 1968, section 2.2.2).
    EXPECT_NEAR(told.right, phi(std::sqrt(d / 2)), 2e-3); // a step on 1601 points
    EXPECT_NEAR(told.decided, phi((d - std::log(19)) / std::sqrt(2 * d)), 4e-3);
    EXPECT_EQ(told.hardest_log_bayes, d);
  }
  const double weak[] = {0, 0.01, 0.01, 0};
  // To first order a quarter of the divergence, as Jensen and Shannon's of two near normals.
  EXPECT_NEAR(discrimination(weak, prior, 1).information_bits, 0.01 / 4 / std::log(2.0), 5e-5);
  const double strong[] = {0, 200, 200, 0};
  EXPECT_NEAR(discrimination(strong, prior, 1).information_bits, 1, 1e-9);
}

TEST(Design, TwoThatAreAlikeAndAThirdFarAway) {
  // Which of the two it is stays open: 1/3 log2 3 + 2/3 log2 (3/2) bit, and only the third is sure.
  const double unlike[] = {0, 1e-5, 900, 1e-5, 0, 1000, 300, 500, 0}, prior[] = {1, 1, 1};
  const Discrimination told = discrimination(unlike, prior, 1);
  EXPECT_NEAR(told.information_bits, std::log2(3.) - 2. / 3, 1e-3);
  EXPECT_NEAR(told.decided, 1. / 3, 1e-9);
  EXPECT_NEAR(told.right, 2. / 3, 1e-2); // a coin between the two, 4096 draws
  EXPECT_EQ(told.hardest_log_bayes, 1e-5);
}

TEST(Design, AlikeAlternativesAreNotToldApart) {
  const double none[] = {0, 0, 0, 0}, prior[] = {3, 1};
  const Discrimination told = discrimination(none, prior, 1);
  EXPECT_NEAR(told.information_bits, 0, 1e-12);
  EXPECT_NEAR(told.right, 0.75, 1e-12); // the likelier one before is so after
  EXPECT_EQ(told.decided, 0);
}

TEST(Design, AFaintRowSaysNothingOfItsPolarization) {
  const ObservedCurve layout = layout_of(2);
  Alternative a = boxed(layout, {}, 20);
  a.errors.q_sd[1] = std::nan("");
  a.errors.i_sd[2] = std::nan("");
  const ObservedCurve curve = expected_curve(layout, a);
  EXPECT_TRUE(std::isnan(curve.samples[1].q));
  EXPECT_TRUE(std::isnan(curve.samples[2].i));
  EXPECT_FALSE(std::isnan(curve.samples[3].i));
}

} // namespace
} // namespace umov
