// Local fits against what they must give back.

#include "light/between/replicates.h"
#include "light/between/smoothing.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/random.h>

namespace umov {
namespace {

/// Near to normal: the sum of twelve uniform numbers, less six.
double noise(std::uint64_t seed, std::uint64_t index) {
  double out = -6;
  for (std::uint32_t k = 0; k < 3; ++k)
    for (const double u : uniform4(seed, k, index))
      out += u;
  return out;
}

struct Noisy {
  std::vector<double> place, draws, value;
};

/// `truth` at even places, with noise of a standard deviation per replicate.
template <class Truth> Noisy noisy(std::size_t count, double deviation, const Truth &truth) {
  Noisy out;
  for (std::size_t k = 0; k < count; ++k) {
    out.place.push_back(0.002 * static_cast<double>(k));
    out.draws.push_back(32);
  }
  for (std::size_t r = 0; r < replicates; ++r)
    for (std::size_t k = 0; k < count; ++k)
      out.value.push_back(truth(out.place[k]) + deviation * noise(7, r * count + k));
  return out;
}

TEST(LocalFits, GiveAParabolaBackExactly) {
  const auto truth = [](double x) { return 3 - 2 * x + 5 * x * x; };
  const Noisy of = noisy(60, 0, truth);
  const LocalFits fits(of.place, of.draws, 1);
  for (std::size_t k = 0; k < of.place.size(); ++k)
    EXPECT_NEAR(fits.at(k, of.value).mean, truth(of.place[k]), 1e-12);
}

TEST(LocalFits, AverageNoiseAndSayHowMuchIsLeft) {
  // The widest window of 129 leaves 9/4 of the variance of a mean of as many.
  const auto truth = [](double x) { return 1 + x; };
  const Noisy of = noisy(301, 0.1, truth);
  const LocalFits fits(of.place, of.draws, 1);
  int inside = 0;
  double squares = 0;
  for (std::size_t k = 0; k < of.place.size(); ++k) {
    const Smoothed at = fits.at(k, of.value);
    inside += std::abs(at.mean - truth(of.place[k])) <= at.half_width ? 1 : 0;
    squares += std::pow(at.mean - truth(of.place[k]), 2);
  }
  const double alone = 0.1 / std::sqrt(static_cast<double>(replicates));
  // 1/7.6 where every window is the widest; by chance some stop before (1/2.5 when this was
  // written).
  EXPECT_LT(std::sqrt(squares / 301), alone / 2);
  EXPECT_GT(inside, 0.9 * 301);
}

TEST(LocalFits, DoNotSmearAStep) {
  const auto truth = [](double x) { return x < 0.2 ? 1.0 : 2.0; };
  const Noisy of = noisy(201, 0.05, truth);
  const LocalFits fits(of.place, of.draws, 1);
  for (std::size_t k = 0; k < of.place.size(); ++k)
    EXPECT_NEAR(fits.at(k, of.value).mean, truth(of.place[k]), 0.08) << k;
}

TEST(LocalFits, TakeTheMeanAtOnePlace) {
  const std::vector<double> place(9, 0.3), draws(9, 32);
  std::vector<double> value;
  for (std::size_t r = 0; r < replicates; ++r)
    for (std::size_t k = 0; k < 9; ++k)
      value.push_back(2 + 0.01 * noise(5, r * 9 + k));
  const Smoothed at = LocalFits(place, draws, 0.5).at(4, value);
  EXPECT_NEAR(at.mean, 2, at.half_width);
  EXPECT_TRUE(std::isfinite(at.half_width));
}

TEST(LocalFits, SmoothTheEndsToo) {
  const Noisy of = noisy(40, 0.1, [](double x) { return 1 + x; });
  const LocalFits fits(of.place, of.draws, 1);
  for (const std::size_t k : {std::size_t{0}, of.place.size() - 1}) {
    const Smoothed at = fits.at(k, of.value);
    EXPECT_GT(at.draws, 4 * 32);
    EXPECT_NEAR(at.mean, 1 + of.place[k], 2 * at.half_width);
  }
}

TEST(LocalFits, DoNotTakeFewEmptyDrawsForDarkness) {
  // The paths of one place have met nothing, where all around there is light.
  std::vector<double> place, draws, value;
  for (std::size_t k = 0; k < 17; ++k) {
    place.push_back(0.001 * static_cast<double>(k));
    draws.push_back(32);
  }
  for (std::size_t r = 0; r < replicates; ++r)
    for (std::size_t k = 0; k < 17; ++k)
      value.push_back(k != 8 && uniform4(9, 0, r * 17 + k)[0] < 0.1 ? 10 : 0); // rare and bright
  const Smoothed at = LocalFits(place, draws, 1).at(8, value);
  EXPECT_GT(at.mean, 0.3);
  EXPECT_GT(at.half_width, 0.1);
}

TEST(LocalFits, KeepToTheirReach) {
  const std::vector<double> place{0, 10, 20, 30, 40, 50}, draws(6, 32);
  std::vector<double> value;
  for (std::size_t r = 0; r < replicates; ++r)
    for (std::size_t k = 0; k < 6; ++k)
      value.push_back(static_cast<double>(k * k * k) + 0.001 * noise(3, r * 6 + k));
  const Smoothed at = LocalFits(place, draws, 5).at(3, value);
  EXPECT_EQ(at.draws, 32);
  EXPECT_NEAR(at.mean, 27, 0.01);
}

} // namespace
} // namespace umov
