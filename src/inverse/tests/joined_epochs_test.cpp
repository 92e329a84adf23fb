#include "inverse/tests/box_light.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <umov/core/quantity.h>
#include <umov/inverse/joined_epochs.h>
#include <umov/inverse/likelihood.h>

namespace umov {
namespace {

constexpr JoinLimits limits{0.005, 0.01};

/// An observer who moves by `step` [rad] from epoch to epoch, the Sun at right angles.
ObservedEpoch seen_from(double angle, double seconds) {
  ObservedEpoch out;
  out.seconds = seconds;
  out.to_sun = {0, 0, 1};
  out.to_observer = {std::cos(angle), std::sin(angle), 0};
  return out;
}

ObservedCurve curve_of(std::size_t count, double step) {
  ObservedCurve out;
  out.bands = {"a", "b"};
  for (std::size_t e = 0; e < count; ++e)
    out.epochs.push_back(seen_from(step * static_cast<double>(e), static_cast<double>(e)));
  return out;
}

ObservedSample sample(std::size_t epoch, std::size_t band, double i, double q, double u) {
  ObservedSample out;
  out.epoch = epoch;
  out.band = band;
  out.i = i;
  out.i_sd = 0.1;
  out.q = q;
  out.u = u;
  out.cov_qq = out.cov_uu = 0.0004;
  out.cov_qu = 0.0001;
  return out;
}

double minus_2_log(const ObservedCurve &curve, double i_a, double i_b, double q) {
  std::vector<double> i, of_q, of_u;
  for (std::size_t e = 0; e < curve.epochs.size(); ++e)
    for (const double in_i : {i_a, i_b}) {
      i.push_back(in_i);
      of_q.push_back(q * in_i);
      of_u.push_back(0.1 * q * in_i);
    }
  return CurveLikelihood(curve, noise_alone()).compare({i, of_q, of_u}).minus_2_log;
}

TEST(JoinedEpochs, AMeanTellsModelsApartAsItsRowsDo) {
  // Sums over n rows of (x - m)^2/v are n (mean - m)^2/v and a part without m: for models that are
  // constant the difference of two -2 ln L is the same, in closed form.
  ObservedCurve curve = curve_of(40, 1e-5);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (std::size_t e = 0; e < 40; ++e)
    for (std::size_t band = 0; band < 2; ++band)
      curve.samples.push_back(sample(e, band, 1 + 0.1 * normal(random), 0.2 + 0.02 * normal(random),
                                     0.02 * normal(random)));
  const ObservedCurve few = joined_epochs(curve, limits);
  ASSERT_EQ(few.epochs.size(), 1u);
  ASSERT_EQ(few.samples.size(), 2u);
  EXPECT_NEAR(few.epochs[0].seconds, 19.5, 1e-9); // of 0 to 39
  EXPECT_NEAR(few.samples[0].i_sd, 0.1 / std::sqrt(40.0), 1e-12);
  const auto apart = [](const ObservedCurve &of) {
    return minus_2_log(of, 1, 1.05, 0.22) - minus_2_log(of, 1, 0.9, 0.15);
  };
  EXPECT_GT(std::abs(apart(curve)), 100);
  // An error of 1e-4 of I, the least that a likelihood takes, counts once in each row.
  EXPECT_NEAR(apart(few), apart(curve), 1e-5 * std::abs(apart(curve)));
}

TEST(JoinedEpochs, AStretchIsNoWiderThanItsLimits) {
  ObservedCurve curve = curve_of(100, 0.001);
  for (std::size_t e = 0; e < 100; ++e)
    curve.samples.push_back(sample(e, 0, static_cast<double>(e), 0, 0));
  const ObservedCurve few = joined_epochs(curve, limits);
  // The bisector of right angles moves by 1/sqrt(2) of the observer: .005 rad in 7.07 steps, so
  // eight epochs are one.
  ASSERT_EQ(few.epochs.size(), 13u);
  ASSERT_EQ(few.samples.size(), 13u);
  for (std::size_t e = 0; e < 13; ++e) {
    EXPECT_EQ(few.samples[e].epoch, e);
    const double middle = e < 12 ? 8 * static_cast<double>(e) + 3.5 : 97.5;
    EXPECT_NEAR(few.samples[e].i, middle, 1e-12);
    EXPECT_NEAR(std::atan2(few.epochs[e].to_observer.y, few.epochs[e].to_observer.x),
                0.001 * middle, 1e-9);
  }
}

TEST(JoinedEpochs, SitesThatTakeTurnsKeepTheirDirections) {
  ObservedCurve curve;
  curve.bands = {"a", "b"};
  for (std::size_t e = 0; e < 20; ++e) {
    curve.epochs.push_back(seen_from(e % 2 == 0 ? 0 : 0.1, static_cast<double>(e)));
    curve.samples.push_back(sample(e, 0, e % 2 == 0 ? 1 : 2, 0, 0));
  }
  const ObservedCurve few = joined_epochs(curve, limits);
  ASSERT_EQ(few.epochs.size(), 2u);
  ASSERT_EQ(few.samples.size(), 2u);
  EXPECT_EQ(few.samples[0].i, 1);
  EXPECT_EQ(few.samples[1].i, 2);
}

TEST(JoinedEpochs, RowsThatAreNotAlikeStayApart) {
  ObservedCurve curve = curve_of(4, 1e-6);
  curve.samples = {sample(0, 0, 1, 0.1, 0), sample(1, 0, 1, 0.1, 0), sample(2, 0, 1, 0.1, 0),
                   sample(3, 0, 1, 0.1, 0)};
  curve.samples[1].i_sd = 0.3;                            // a worse one
  curve.samples[2].q = curve.samples[2].u = std::nan(""); // I alone
  curve.samples[3].i_sd = 0.19;                           // like the first
  const ObservedCurve few = joined_epochs(curve, limits);
  ASSERT_EQ(few.samples.size(), 3u);
  EXPECT_EQ(few.epochs.size(), 3u); // each at the times of its own
  EXPECT_EQ(few.samples[0].i_sd, 0.3);
  EXPECT_NEAR(few.samples[1].i_sd, std::hypot(0.1, 0.19) / 2, 1e-12); // of 0 and 3 s: 1.5 s
  EXPECT_TRUE(std::isnan(few.samples[2].q));
}

/// An analyser at an angle, in exposures of 1 s.
ObservedCount count(std::size_t epoch, double analyser, double net) {
  ObservedCount out;
  out.epoch = epoch;
  out.net = net;
  out.sky = 3;
  out.fixed_variance = 9;
  out.scintillation = 0.02;
  out.by_i = 50;
  out.by_q = 50 * std::cos(2 * analyser);
  out.by_u = 50 * std::sin(2 * analyser);
  return out;
}

TEST(JoinedEpochs, CountsOfAnAnalyserAddUpAtItsOwnTime) {
  constexpr double step = 0.0005; // the bisector moves by a fourteenth of the limit
  ObservedCurve curve = curve_of(8, step);
  double all = 0;
  for (std::size_t e = 0; e < 8; ++e) {
    curve.counts.push_back(count(e, static_cast<double>(e % 4) * pi / 4, 100 + double(e)));
    all += curve.counts.back().net;
  }
  const ObservedCurve few = joined_epochs(curve, limits);
  ASSERT_EQ(few.counts.size(), 4u);
  ASSERT_EQ(few.epochs.size(), 4u);
  double sum = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    const ObservedCount &one = few.counts[c];
    EXPECT_EQ(one.epoch, c);
    EXPECT_NEAR(few.epochs[c].seconds, static_cast<double>(c) + 2, 1e-12); // of c and c + 4
    EXPECT_EQ(one.sky, 6);
    EXPECT_EQ(one.fixed_variance, 18);
    EXPECT_EQ(one.by_i, 100);
    EXPECT_NEAR(one.by_q, 100 * std::cos(static_cast<double>(c) * pi / 2), 1e-12);
    EXPECT_NEAR(one.scintillation, 0.02 / std::sqrt(2.0), 1e-12); // two that flicker by themselves
    EXPECT_EQ(one.set, no_set);
    sum += one.net;
  }
  EXPECT_EQ(sum, all);
}

TEST(JoinedEpochs, ChannelsOfTheSameExposuresStayTogether) {
  // What moves the channels of an exposure together, as transparency does, moves the sums so.
  ObservedCurve curve = curve_of(60, 1e-6);
  for (std::size_t e = 0; e < 60; ++e)
    for (const double analyser : {0.0, pi / 2})
      if (e != 7 || analyser == 0) // saturated
        curve.counts.push_back(count(e, analyser, 10));
  curve.counts.push_back(count(59, pi / 2, 4)); // as the one before, in the same exposure
  const ObservedCurve few = joined_epochs(curve, limits);
  // 58 exposures of two channels, one of one, one of three.
  ASSERT_EQ(few.counts.size(), 6u);
  ASSERT_EQ(few.epochs.size(), 3u);
  EXPECT_EQ(few.counts[0].net, 10);
  EXPECT_EQ(few.counts[1].epoch, few.counts[2].epoch);
  EXPECT_EQ(few.counts[1].net, 580);
  EXPECT_EQ(few.counts[2].net, 580);
  EXPECT_EQ(few.counts[5].net, 4);
  // Sequences are of no exposure together, however many there are.
  curve.counts.clear();
  for (std::size_t e = 0; e < 60; ++e)
    curve.counts.push_back(count(e, e % 2 == 0 ? 0 : pi / 2, 10));
  const ObservedCurve turns = joined_epochs(curve, limits);
  EXPECT_EQ(turns.counts.size(), 2u);
  EXPECT_EQ(turns.epochs.size(), 2u);
}

TEST(JoinedEpochs, ACurveThatIsNotDenseIsAsItWas) {
  ObservedCurve curve = curve_of(10, 0.02);
  for (std::size_t e = 0; e < 10; ++e)
    curve.samples.push_back(sample(e, 0, 1, 0.1, 0));
  curve.samples[3].set = 5;
  const ObservedCurve same = joined_epochs(curve, limits);
  EXPECT_EQ(same.epochs.size(), 10u);
  EXPECT_EQ(same.samples[3].set, 5u);
  EXPECT_TRUE(joined_epochs({}, limits).epochs.empty());
}

} // namespace
} // namespace umov
