#include "reduction/tests/anchor.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <umov/instrument/draws.h>
#include <umov/reduction/sequence.h>

namespace umov {
namespace {

std::vector<double> radians(const std::vector<double> &degrees) {
  std::vector<double> out;
  for (const double d : degrees)
    out.push_back(d * pi / 180);
  return out;
}

TEST(Sequence, DriftLooksLikePolarization) {
  // 1 % a step about the mean.
  const std::vector<double> four{.985, .995, 1.005, 1.015};
  const auto plain = false_polarization(radians({0, 45, 90, 135}), four);
  EXPECT_NEAR(plain.real(), -.01, 1e-12);
  EXPECT_NEAR(plain.imag(), -.01, 1e-12);
  const auto crossed = false_polarization(radians({0, 90, 45, 135}), four);
  EXPECT_NEAR(crossed.real(), -.005, 1e-12);
  std::vector<double> eight;
  for (int k = 0; k < 8; ++k)
    eight.push_back(.965 + .01 * k);
  const auto mirrored = false_polarization(radians({0, 45, 90, 135, 135, 90, 45, 0}), eight);
  EXPECT_NEAR(std::abs(mirrored), 0, 1e-12);
}

TEST(Sequence, TumbleLooksLikePolarization) { // seven digits
  struct Case {
    const char *name;
    std::vector<double> angles;
    double exposure;
  };
  for (const Case &c : {Case{"plain", {0, 45, 90, 135}, 1},
                        {"crossed", {0, 90, 45, 135}, 1},
                        {"mirrored", {0, 45, 90, 135, 135, 90, 45, 0}, 1},
                        {"quick", {0, 45, 90, 135}, .05}}) {
    double squares = 0, largest = 0;
    for (int f = 0; f < 73; ++f) {
      const double phase = 2 * pi * f / 72, rate = 2 * pi / 10;
      const auto sum = [&](double t) { return t + .3 / rate * std::sin(rate * t + phase); };
      std::vector<double> light;
      for (std::size_t k = 0; k < c.angles.size(); ++k) {
        const double begin = static_cast<double>(k) * c.exposure;
        light.push_back(sum(begin + c.exposure) - sum(begin));
      }
      const double p = std::abs(false_polarization(radians(c.angles), light));
      squares += p * p / 73;
      largest = std::max(largest, p);
    }
    const std::string name = std::string("tumble_") + c.name;
    EXPECT_NEAR(std::sqrt(squares), of(name + "_rms"), 1e-7);
    EXPECT_NEAR(largest, of(name + "_largest"), 1e-7);
  }
}

/// 240 single-beam exposures of .25 s of a body that tumbles in 7.3 s, +-35 and 20 %.
std::vector<TimedDatum> tumbling(std::uint32_t trial) {
  std::vector<TimedDatum> out;
  Draws draws({53, 0, trial, 0, 0});
  const double f1 = 2 * pi * draws.normal(), f2 = 2 * pi * draws.normal();
  for (int k = 0; k < 240; ++k) {
    const double t = .25 * k + .125, phase = 2 * pi * t / 7.3;
    const double light = 2e4 * (1 + .35 * std::cos(phase + f1) + .2 * std::cos(2 * phase + f2));
    const double a = four_angles[k % 4] * pi / 90;
    const StokesRow row{.5, .5 * std::cos(a), .5 * std::sin(a), 0};
    const double mean = light * (row[0] + row[1] * .1 - row[2] * .05) + 50;
    out.push_back({t, {draws.poisson(mean) + 10 * draws.normal(), 50, 100, 1, row}});
  }
  return out;
}

TEST(Sequence, RawCountsTellATumblingBodysPolarization) {
  double s = 0, ss = 0, differenced = 0, scattered = 0;
  constexpr std::uint32_t trials = 400; // mean .05, sd .035
  for (std::uint32_t t = 0; t < trials; ++t) {
    const auto data = tumbling(t);
    const auto fit = fit_sequence(data, 7.3, 3, 3);
    ASSERT_TRUE(fit);
    const double pull = (fit->fractions.value[0] - .1) / std::sqrt(fit->fractions.covariance[0][0]);
    s += pull, ss += pull * pull;
    double sum = 0, weights = 0, squares = 0; // of cycles' q, weighted by their photons
    for (std::size_t k = 0; k + 3 < data.size(); k += 4) {
      const double a = data[k].datum.counts - 50, b = data[k + 2].datum.counts - 50;
      const double c = data[k + 1].datum.counts + data[k + 3].datum.counts - 100;
      const double off = (a - b) / (a + b) - .1, weight = (a + b + c) / 2; // 1/variance
      sum += weight * off, weights += weight, squares += weight * off * off;
    }
    differenced += sum * sum / weights / trials;
    scattered += squares / 60 / trials;
  }
  const double mean = s / trials;
  EXPECT_NEAR(mean, 0, .15);
  EXPECT_NEAR(std::sqrt(ss / trials - mean * mean), 1, .1);
  // The mean of 60 differenced cycles over its photon error, and a cycle over its own.
  EXPECT_GT(std::sqrt(differenced), 3);
  EXPECT_GT(std::sqrt(scattered), 3);
}

TEST(Sequence, SplinesNeedNoPeriod) {
  double s = 0, ss = 0;
  constexpr std::uint32_t trials = 200; // mean .07, sd .05
  for (std::uint32_t t = 0; t < trials; ++t) {
    const auto data = tumbling(t);
    const auto fit =
        fit_spline(data, 1, 3); // the shortest wave, 3.65 s, over three and a half knots
    ASSERT_TRUE(fit);
    const double pull = (fit->fractions.value[0] - .1) / std::sqrt(fit->fractions.covariance[0][0]);
    s += pull, ss += pull * pull;
    EXPECT_NEAR(fit->mean / 2e4, 1, .05); // eight turns and a fifth
  }
  const double mean = s / trials;
  EXPECT_NEAR(mean, 0, .3);
  EXPECT_NEAR(std::sqrt(ss / trials - mean * mean), 1, .2);
}

TEST(Sequence, TooManyKnotsAreRefused) {
  const auto data = tumbling(0);
  EXPECT_FALSE(fit_spline(data, 1e-3, 3));
  EXPECT_FALSE(fit_spline(std::span(data).first(5), .25, 3));
}

TEST(Sequence, TooShortSeriesAreRefused) {
  const auto data = tumbling(0);
  EXPECT_FALSE(fit_sequence(std::span(data).first(8), 7.3, 3, 3));
}

} // namespace
} // namespace umov
