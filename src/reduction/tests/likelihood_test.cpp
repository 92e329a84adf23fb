#include "reduction/tests/anchor.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <umov/instrument/draws.h>
#include <umov/reduction/likelihood.h>

namespace umov {
namespace {

struct Case {
  double counts;
  int mean;
  double read;
};

TEST(Likelihood, OfOneSumOfElectrons) { // eight digits
  for (const Case &c : {Case{3.2, 5, 1.6}, {52.3, 45, 3}, {1012, 980, 7}}) {
    const std::string name = "_" + std::to_string(c.mean);
    EXPECT_NEAR(log_poisson_gauss(c.counts, c.mean, c.read), of("exact" + name), 1e-6);
    EXPECT_NEAR(log_shifted_poisson(c.counts, c.mean, c.read * c.read), of("shifted" + name), 1e-6);
    EXPECT_NEAR(log_normal_counts(c.counts, c.mean, c.read * c.read), of("normal" + name), 1e-6);
  }
}

TEST(Likelihood, OfAMultiplyingRegister) { // a sum over what went in, eight digits
  EXPECT_NEAR(log_multiplied(1500, 3, 300), of("multiplied"), 1e-6);
  // Beyond the range of the Bessel function it goes on smoothly.
  const double a = 499.9999 * 499.9999 / 4, b = 500.0001 * 500.0001 / 4;
  EXPECT_NEAR(log_multiplied(300 * a / 10, 10, 300), log_multiplied(300 * b / 10, 10, 300),
              .006); // its slope: .0048
}

TEST(Likelihood, OfASaturatedPixel) {
  EXPECT_NEAR(log_saturated(1000, 1000, 0), std::log(.5), 1e-12);
  EXPECT_NEAR(log_saturated(1000, 5000, 0), 0, 1e-12);
  EXPECT_LT(log_saturated(1000, 10, 0), -1000); // finite where erfc underflows
  EXPECT_TRUE(std::isfinite(log_saturated(1000, 10, 0)));
}

/// Where a function of one hill has its top.
double top_of(const std::function<double(double)> &f, double a, double b) {
  const double golden = (std::sqrt(5.) - 1) / 2;
  while (b - a > 1e-4) {
    const double c = b - golden * (b - a), d = a + golden * (b - a);
    (f(c) < f(d) ? a : b) = f(c) < f(d) ? c : d;
  }
  return (a + b) / 2;
}

/// Forty counts, read with 1.6 e: the likelihood's mean is that of the light, where counts that are
/// weighted by their own size fall short by 38, 22 and 5 %.
TEST(Likelihood, MeansOfFaintCountsHaveNoBias) {
  constexpr std::uint32_t trials = 1500, samples = 40;
  constexpr double read = 1.6;
  for (const int mean : {2, 5, 20}) {
    double found = 0, weighted = 0;
    for (std::uint32_t t = 0; t < trials; ++t) {
      Draws draws({51, 0, t, static_cast<std::uint32_t>(mean), 0});
      std::vector<double> counts;
      for (std::uint32_t k = 0; k < samples; ++k)
        counts.push_back(draws.poisson(mean) + read * draws.normal());
      const auto likelihood = [&](double m) {
        double out = 0;
        for (const double n : counts)
          out += log_shifted_poisson(n, m, read * read);
        return out;
      };
      found += top_of(likelihood, .2 * mean, 3 * mean) / trials;
      double sum = 0, weights = 0;
      for (const double n : counts) {
        const double weight = 1 / (std::max(n, 0.) + read * read);
        sum += weight * n, weights += weight;
      }
      weighted += sum / weights / trials;
    }
    const double scatter = std::sqrt((mean + read * read) / (trials * samples));
    EXPECT_NEAR(found, mean, 3 * scatter) << mean;
    // Six digits for many samples; of forty, the weight itself is a little uncertain.
    EXPECT_NEAR(weighted / of("data_weighted_" + std::to_string(mean)), 1, .02) << mean;
  }
}

TEST(Likelihood, MeanIsNotDrawnDown) {
  // The shifted Poisson number is largest for a mean that is the counts' mean.
  for (const double mean : {2., 5., 20.}) {
    const auto total = [&](double m) {
      double out = 0;
      for (const double off : {-1.5, -.5, .5, 1.5})
        out += log_shifted_poisson(mean + off, m, 2.56);
      return out;
    };
    EXPECT_GT(total(mean), total(mean * 1.01));
    EXPECT_GT(total(mean), total(mean * .99));
  }
}

} // namespace
} // namespace umov
