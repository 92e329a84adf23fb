#include <umov/lightcurve/repetition.h>

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <umov/core/quantity.h>
#include <vector>

namespace umov {
namespace {

struct Series {
  std::vector<double> seconds, magnitudes;
};

/// A light curve of two maxima in a turn of `2 * period_s`: those of every second differ by
/// `uneven`, brightness drifts and swells, and noise of .1 stands on it; `red` of it lasts from one
/// value to the next.
Series curve(double period_s, double span_s, double uneven, double red, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 0.1);
  Series out;
  double noise = 0;
  for (double t = 0; t <= span_s; t += 1.5) {
    noise = red * noise + std::sqrt(1 - red * red) * normal(random);
    const double turn = 2 * pi * t / period_s, swell = 1 + 0.3 * std::sin(t / span_s * 2);
    out.seconds.push_back(t);
    out.magnitudes.push_back(8 - 2e-3 * t +
                             swell * (0.3 * std::sin(turn) + 0.15 * std::cos(2 * turn)) +
                             uneven * std::sin(turn / 2 + 1) + noise);
  }
  return out;
}

/// Of 400 noises, how many give a false alarm below .05.
int alarms(double red) {
  int out = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const Series s = curve(20, 400, 0, red, seed);
    const Alternation found = alternation(s.seconds, s.magnitudes, 20);
    EXPECT_TRUE(found.is_told);
    out += found.false_alarm < 0.05 ? 1 : 0;
  }
  return out;
}

TEST(Repetition, NoiseRaisesAsManyFalseAlarmsAsAreSaid) {
  // 400 trials of .05 have 20 with a standard deviation of 4.4; three of those either way.
  EXPECT_NEAR(alarms(0), 20, 13);
  // Red noise is compared with itself beside each frequency; what is left of its slope is small.
  EXPECT_NEAR(alarms(0.7), 20, 15);
}

TEST(Repetition, TurnsThatDifferAreSeen) {
  // sin(turn / 2) has the amplitude a: one turn less the next is 2 a sin(...), 2 a / sqrt 2 in the
  // root mean square. Noise adds 2 * .1 sqrt(6 / 267) = .03 to it, in quadrature.
  for (const double a : {0.08, 0.2}) {
    const Series s = curve(20, 400, a, 0, 7);
    const Alternation found = alternation(s.seconds, s.magnitudes, 20);
    EXPECT_LT(found.false_alarm, 1e-3);
    EXPECT_NEAR(found.difference, std::hypot(std::sqrt(2.0) * a, 0.03), 0.03);
  }
}

TEST(Repetition, WithoutNoiseAHarmonicIsNoAlternation) {
  // Drift and swell stand beside the harmonics of the period as beside those of half its frequency.
  Series s = curve(20, 400, 0, 0, 1);
  for (std::size_t k = 0; k < s.seconds.size(); ++k) {
    const double turn = 2 * pi * s.seconds[k] / 20;
    s.magnitudes[k] = 8 + (1 + 0.3 * s.seconds[k] / 400) * std::exp(std::cos(turn));
  }
  EXPECT_GT(alternation(s.seconds, s.magnitudes, 20).false_alarm, 0.01);
}

TEST(Repetition, FewTurnsTellNothing) {
  const Series s = curve(20, 100, 0.5, 0, 3);
  const Alternation found = alternation(s.seconds, s.magnitudes, 20);
  EXPECT_FALSE(found.is_told);
  EXPECT_EQ(found.false_alarm, 1);
  EXPECT_NEAR(found.turns, 5, 0.1);
  EXPECT_FALSE(alternation(std::vector<double>(3), std::vector<double>(3), 20).is_told);
}

} // namespace
} // namespace umov
