#include "inverse/tests/box_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <umov/inverse/likelihood.h>

namespace umov {
namespace {

/// Two bands, ten epochs, errors of 5 %.
ObservedCurve sample(const std::vector<double> &model, std::array<double, 2> gain) {
  ObservedCurve out;
  out.bands = {"a", "b"};
  out.epochs.resize(10);
  for (std::size_t e = 0; e < 10; ++e)
    for (std::size_t b = 0; b < 2; ++b) {
      ObservedSample s;
      s.epoch = e;
      s.band = b;
      s.i = gain[b] * model[2 * e + b];
      s.i_sd = 0.05 * s.i;
      out.samples.push_back(s);
    }
  return out;
}

std::vector<double> model_light() {
  std::vector<double> out(20);
  for (std::size_t k = 0; k < 20; ++k)
    out[k] = 1 + 0.5 * std::sin(0.7 * static_cast<double>(k));
  return out;
}

TEST(CurveLikelihood, FindsTheScale) {
  const auto light = model_light();
  const std::vector<double> none(20, 0);
  const CurveLikelihood likelihood(sample(light, {3, 3}), no_floor());
  const Comparison found = likelihood.compare({light, none, none});
  EXPECT_NEAR(found.scale, 3, 1e-9);
  EXPECT_NEAR(found.chi2, 0, 1e-12);
  EXPECT_EQ(likelihood.measurements(), 20u);
}

TEST(CurveLikelihood, AModelThatIsRightIsRightAboutFaintLight) {
  const auto light = model_light();
  const std::vector<double> none(20, 0);
  auto other = light;
  other[3] *= 1.1;
  const auto chi2 = [&](double floor, double of_median) {
    CurveErrors errors;
    errors.floor = floor;
    errors.floor_median = of_median;
    return CurveLikelihood(sample(light, {1, 1}), errors).compare({other, none, none}).chi2;
  };
  constexpr double not_said = -1;
  EXPECT_EQ(chi2(0, not_said), chi2(0, 0)); // errors of the data alone
  EXPECT_EQ(chi2(0.005, not_said), chi2(0.005, 0.0025));
  EXPECT_EQ(chi2(0.02, not_said), chi2(0.02, 0.01));
  EXPECT_EQ(chi2(0.07, not_said), chi2(0.07, 0.01));
}

TEST(CurveLikelihood, WhatIsDarkWithoutAnErrorIsMeasuredByAModelWithoutOne) {
  const auto light = model_light();
  const std::vector<double> none(20, 0);
  ObservedCurve curve = sample(light, {1, 1});
  curve.samples[3].i = curve.samples[3].i_sd = 0;
  const CurveLikelihood likelihood(curve, no_floor());
  EXPECT_EQ(likelihood.measurements(), 20u);
  // Light where none was seen: no scale but 0 will do, which the other 19 are 1/.05 errors off.
  EXPECT_NEAR(likelihood.compare({light, none, none}).chi2, 19 / (0.05 * 0.05), 1);
}

/// Least of sum ((d - g_b m)/s)^2 + sum ((g_b - s0)/(z s1))^2 over g_a, g_b and s0 by brute force,
/// s1 being the scale without zero points: the definition, minimised without its algebra.
double least_chi2(const ObservedCurve &curve, const std::vector<double> &m, double z) {
  const auto of = [&](double s0, double s1) {
    double out = 0;
    for (std::size_t b = 0; b < 2; ++b) {
      double best = 1e300;
      for (double g = 2.5; g < 3.5; g += 1e-4) {
        double chi2 = std::pow((g - s0) / (z * s1), 2);
        for (const ObservedSample &s : curve.samples)
          if (s.band == b)
            chi2 += std::pow((s.i - g * m[2 * s.epoch + b]) / s.i_sd, 2);
        best = std::min(best, chi2);
      }
      out += best;
    }
    return out;
  };
  double cross = 0, square = 0;
  for (const ObservedSample &s : curve.samples) {
    const double x = m[2 * s.epoch + s.band];
    cross += s.i * x / (s.i_sd * s.i_sd);
    square += x * x / (s.i_sd * s.i_sd);
  }
  double best = 1e300;
  for (double s0 = 2.9; s0 < 3.2; s0 += 5e-3)
    best = std::min(best, of(s0, cross / square));
  return best;
}

TEST(CurveLikelihood, ZeroPointsAreNormalAroundTheScale) {
  const auto light = model_light();
  const std::vector<double> none(20, 0);
  const ObservedCurve curve = sample(light, {3, 3.12});
  const Comparison found = CurveLikelihood(curve, no_floor()).compare({light, none, none});
  // 5e-3 in s0 and 1e-4 in g leave less than 0.003 in chi2.
  EXPECT_NEAR(found.chi2, least_chi2(curve, light, 0.02), 0.005);
  EXPECT_GT(found.chi2, 0.5);
}

TEST(CurveLikelihood, PolarizationIsWhitenedByItsCovariance) {
  ObservedCurve curve;
  curve.bands = {"a"};
  curve.epochs.resize(1);
  ObservedSample s;
  s.q = 0.10;
  s.u = -0.04;
  s.cov_qq = 4e-4;
  s.cov_uu = 9e-4;
  s.cov_qu = 3e-4;
  curve.samples = {s};
  const std::vector<double> i{2}, q{0.1}, u{0.02}; // q = 0.05, u = 0.01
  const Comparison found = CurveLikelihood(curve, no_floor()).compare({i, q, u});
  const double dq = 0.05, du = -0.05, det = 4e-4 * 9e-4 - 9e-8;
  EXPECT_NEAR(found.chi2, (9e-4 * dq * dq - 2 * 3e-4 * dq * du + 4e-4 * du * du) / det, 1e-9);
}

TEST(CurveLikelihood, CloudsTakeWhatIsCommonToTheBandsOfAnEpoch) {
  const auto light = model_light();
  const std::vector<double> none(20, 0);
  ObservedCurve curve = sample(light, {1, 1});
  for (ObservedSample &s : curve.samples)
    s.i *= 0.3 + 0.07 * static_cast<double>(s.epoch);
  CurveErrors errors = no_floor();
  EXPECT_GT(CurveLikelihood(curve, errors).compare({light, none, none}).chi2, 100);
  errors.has_clouds = true;
  EXPECT_NEAR(CurveLikelihood(curve, errors).compare({light, none, none}).chi2, 0, 1e-9);
}

/// What clouds can do to the light of an epoch says nothing of the model: two that differ by a
/// factor of each epoch are alike behind them.
TEST(CurveLikelihood, BehindCloudsNoModelGainsByBeingDarkInAnEpoch) {
  const auto light = model_light();
  const std::vector<double> none(20, 0);
  const ObservedCurve curve = sample(light, {1, 1});
  auto flash = light;
  for (std::size_t k = 0; k < flash.size(); ++k)
    flash[k] *= k < 2 ? 1 : 0.01; // two bands an epoch: all but the first are dark beside it
  CurveErrors errors = no_floor();
  errors.has_clouds = true;
  const CurveLikelihood likelihood(curve, errors);
  EXPECT_NEAR(likelihood.compare({flash, none, none}).minus_2_log,
              likelihood.compare({light, none, none}).minus_2_log, 1e-6);
}

TEST(CurveLikelihood, OutliersDoNotMoveTheScale) {
  const auto light = model_light();
  const std::vector<double> none(20, 0);
  ObservedCurve curve = sample(light, {1, 1});
  curve.samples[7].i *= 4; // sixty standard deviations
  CurveErrors errors = no_floor();
  const double moved = CurveLikelihood(curve, errors).compare({light, none, none}).scale;
  errors.outlier_share = 0.05;
  const double held = CurveLikelihood(curve, errors).compare({light, none, none}).scale;
  EXPECT_GT(std::abs(moved - 1), 0.05);
  EXPECT_LT(std::abs(held - 1), 0.01); // a hundredth of its weight is left
}

TEST(CurveLikelihood, AModelThatIsNotSureIsNotHeldToIt) {
  const auto light = model_light();
  const std::vector<double> none(20, 0);
  ObservedCurve curve = sample(light, {1, 1});
  curve.samples[7].i *= 1.5; // ten standard deviations
  std::vector<double> width(20, 0);
  width[7] = 1.96 * light[7]; // the model's own error is all of it there
  const CurveLikelihood likelihood(curve, no_floor());
  const Comparison sure = likelihood.compare({light, none, none});
  const Comparison unsure = likelihood.compare({light, none, none, width});
  EXPECT_GT(sure.chi2, 20);
  EXPECT_LT(unsure.chi2, 1); // half of one standard deviation, squared
  // What the variance has grown by is paid for: ln(1 + (s m / .05 m)^2) = 6.04 with the first scale
  // s = 1.025; the integrals over gains and scale lose .07 + .02 + 2 ln 1.025 with the row.
  EXPECT_NEAR(unsure.minus_2_log - unsure.chi2 - (sure.minus_2_log - sure.chi2), 5.9, 0.05);
}

TEST(CurveLikelihood, EveryUnknownHasAPrior) {
  const CurveLikelihood likelihood(sample(model_light(), {1, 1}), CurveErrors());
  const auto all = likelihood.nuisances();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].prior, Prior::LogFlat);
  EXPECT_DOUBLE_EQ(log_prior(all[0], 10) - log_prior(all[0], 1), -std::log(10.0));
  EXPECT_DOUBLE_EQ(log_prior(all[1], 0.04), -2.0); // two of its standard deviations
  EXPECT_EQ(log_prior(all[1], 2), -std::numeric_limits<double>::infinity());
}

} // namespace
} // namespace umov
