#include "reduction/tests/anchor.h"

#include <gtest/gtest.h>
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

TEST(Likelihood, SetsWithCommonErrorsAreTheFullMatrix) {
  // Woodbury's small matrix against the fit's full one (nine digits in the anchors).
  const auto data = worked_set();
  const auto first = fit_stokes(data, 3);
  const auto common = common_errors({.002, .005, .0139, 0, 0, 0}, data, *first, 0);
  const auto fit = fit_stokes(data, 3, common);
  std::vector<PredictedCounts> predicted;
  for (const ChannelDatum &one : data)
    predicted.push_back({one,
                         one.sky + one.row[0] * first->stokes[0] + one.row[1] * first->stokes[1] +
                             one.row[2] * first->stokes[2],
                         false, 0});
  // At the first fit's means; the second's residual differs to second order.
  EXPECT_NEAR(-2 * log_likelihood(predicted, common), fit->minus_2_log_likelihood, 1e-3);
  EXPECT_NEAR(fit->minus_2_log_likelihood, of("all_likelihood"), .02); // D in q0's column
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
