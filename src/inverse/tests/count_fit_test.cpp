// Parts and changes from the counts of analysers that follow each other.

#include "inverse/tests/box_light.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <umov/core/quantity.h>
#include <umov/inverse/health.h>
#include <umov/inverse/unmix.h>

namespace umov {
namespace {

constexpr std::size_t steps = 160, analysers = 4;

/// Metal that glints and paint that does not: light of a body that turns by a glint's width between
/// one analyser and the next.
std::vector<EndMember> metal_and_paint() {
  std::vector<EndMember> out{{"metal", {}, {}, {}}, {"paint", {}, {}, {}}};
  for (std::size_t e = 0; e < steps; ++e) {
    const double x = static_cast<double>(e);
    const double glint = std::exp(6 * (std::cos(0.7 * x) - 1));
    out[0].i.push_back(0.2 + 3 * glint);
    out[0].q.push_back(0.3 * out[0].i.back());
    out[1].i.push_back(1 + 0.3 * std::sin(0.2 * x));
    out[1].q.push_back(0.04 * out[1].i.back());
    for (EndMember &one : out)
      one.u.push_back(0);
  }
  return out;
}

/// What the four of a set are reduced to, as of a body that stands still: at the second of them.
ObservedSample reduced(const std::vector<ObservedCount> &all, std::size_t first, double electrons) {
  const double a = all[first].net, b = all[first + 1].net, c = all[first + 2].net,
               d = all[first + 3].net, sum = (a + b + c + d) / 2;
  ObservedSample out;
  out.epoch = first + 1;
  out.i = sum / electrons;
  out.i_sd = std::sqrt(2 * sum) / 2 / electrons;
  out.q = (a - c) / sum;
  out.u = (b - d) / sum;
  out.cov_qq = out.cov_uu = 1 / sum;
  return out;
}

/// One band; `metal` of the area is of metal.
ObservedCurve in_sequence(double metal, std::uint64_t seed) {
  constexpr double electrons = 4000;
  const auto members = metal_and_paint();
  std::mt19937_64 random(seed);
  ObservedCurve out;
  out.bands = {"a"};
  out.epochs.resize(steps);
  for (std::size_t e = 0; e < steps; ++e) {
    const double twice = static_cast<double>(e % analysers) * pi / 2;
    ObservedCount one;
    one.epoch = e;
    one.set = e / analysers;
    one.by_i = electrons / 2;
    one.by_q = electrons / 2 * std::cos(twice);
    one.by_u = electrons / 2 * std::sin(twice);
    const auto of = [&](const EndMember &m) { return one.by_i * m.i[e] + one.by_q * m.q[e]; };
    const double mean = metal * of(members[0]) + (1 - metal) * of(members[1]);
    one.net = static_cast<double>(std::poisson_distribution<int>(mean)(random));
    out.counts.push_back(one);
  }
  for (std::size_t first = 0; first < steps; first += analysers)
    out.samples.push_back(reduced(out.counts, first, electrons));
  return out;
}

constexpr double truth = 0.3;
constexpr int nights = 60;

TEST(CountFit, PartsComeBackWithinTheirErrorsWhateverTheBodyDidBetweenAnalysers) {
  double sum = 0, square = 0, chi2 = 0, reduced_off = 0;
  for (int night = 0; night < nights; ++night) {
    ObservedCurve curve = in_sequence(truth, static_cast<std::uint64_t>(night));
    const Unmixing found = unmix(curve, noise_alone(), metal_and_paint());
    ASSERT_EQ(found.groups.size(), 2u);
    const double pull = (found.groups[0].fraction - truth) / found.groups[0].fraction_err;
    sum += pull;
    square += pull * pull;
    chi2 += found.chi2 / nights;
    EXPECT_EQ(found.measurements, steps);
    curve.counts.clear();
    const Unmixing of_sets = unmix(curve, noise_alone(), metal_and_paint());
    reduced_off += (of_sets.groups[0].fraction - truth) / of_sets.groups[0].fraction_err / nights;
  }
  // Means of 60 pulls: of them 1/sqrt(60) = .13, of their squares sqrt(2/60) = .18; four sigma. The
  // covariance is taken at the fit, to first order, and a weight that goes with the fit is off by
  // a count in its root: less than that.
  EXPECT_NEAR(sum / nights, 0, 0.52);
  EXPECT_NEAR(square / nights, 1, 0.73);
  // Chi-square of 158 degrees of freedom: sqrt(2 * 158 / 60) = 2.3.
  EXPECT_NEAR(chi2, steps - 2., 9.2);
  EXPECT_GT(std::abs(reduced_off), 10); // as sets they say something else
}

TEST(CountFit, ChangesComeBackWithinTheirErrorsWhateverTheBodyDidBetweenAnalysers) {
  const auto members = metal_and_paint();
  const std::vector<LightChange> changes{{"metal=paint", members[1], 1, 0}};
  double sum = 0, square = 0;
  for (int night = 0; night < nights; ++night) {
    // A metal body, of which 1 - truth has turned into paint.
    const ObservedCurve curve = in_sequence(truth, static_cast<std::uint64_t>(100 + night));
    const Health found = check_health(curve, noise_alone(), members[0], changes, {});
    const HealthRow &row = found.rows.front();
    const double pull = (row.change - (1 - truth)) / row.change_err;
    sum += pull;
    square += pull * pull;
    EXPECT_TRUE(row.is_settled);
  }
  EXPECT_NEAR(sum / nights, 0, 0.52);
  EXPECT_NEAR(square / nights, 1, 0.73);
}

TEST(CountFit, LightBelowItsErrorsTellsNeitherPartsNorChanges) {
  ObservedCurve curve = in_sequence(truth, 1);
  for (ObservedCount &one : curve.counts)
    one.fixed_variance = 1e14;
  const auto members = metal_and_paint();
  EXPECT_EQ(unmix(curve, noise_alone(), members).scale, 0);
  const Health found =
      check_health(curve, noise_alone(), members[0], {{"x", members[1], 1, 0}}, {});
  EXPECT_EQ(found.rows.front().change_err, 0);
  EXPECT_LT(found.chi2, steps);
}

TEST(CountFit, LightIsSeenWhateverTheZeroPointsAre) {
  CurveErrors errors = noise_alone();
  errors.zero_point_sd = 3; // no brightness is known, its changes are
  const auto members = metal_and_paint();
  for (const bool has_counts : {true, false}) {
    ObservedCurve curve = in_sequence(truth, 1);
    if (!has_counts)
      curve.counts.clear();
    const Unmixing found = unmix(curve, errors, members);
    EXPECT_GT(found.scale, 0);
    EXPECT_TRUE(std::isfinite(found.groups[0].fraction));
    EXPECT_GT(
        check_health(curve, errors, members[0], {{"x", members[1], 1, 0}}, {}).rows[0].change_err,
        0);
  }
}

TEST(CountFit, AChangeThatTheScaleAloneExplainsIsNotSeen) {
  ObservedCurve curve = in_sequence(truth, 1);
  curve.counts.clear();
  curve.samples.resize(1); // one I, and nothing to hold it against
  curve.samples.front().q = curve.samples.front().u = std::nan("");
  const auto members = metal_and_paint();
  const Health found =
      check_health(curve, noise_alone(), members[0], {{"x", members[1], 1, 0}}, {});
  EXPECT_EQ(found.rows.front().change_err, 0);
}

} // namespace
} // namespace umov
