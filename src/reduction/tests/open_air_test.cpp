#include <umov/reduction/open_air.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <umov/instrument/draws.h>

namespace umov {
namespace {

constexpr std::array<double, 4> light{1e6, .3e6, -.1e6, 0};

double of_light(const StokesRow &row) {
  return respond(row, Stokes<InstrumentAxes>{light[0], light[1], light[2], light[3]});
}

/// Two beams at four positions of a plate, in exposures `step_s` apart, with noise and
/// transparencies of some hundredths.
struct Counted {
  std::vector<ChannelDatum> data;
  std::vector<AirPlace> places;
};
Counted two_beams(int exposures, double step_s, double flicker) {
  Counted out;
  Draws draws({7, 0, 0, 0, 0});
  for (int k = 0; k < exposures; ++k) {
    const double t = 1 + .05 * draws.normal();
    for (const double beam : {0., 90.}) {
      const double a = 2 * (45 * (k % 4) + beam) * pi / 180;
      const StokesRow row{.5, .5 * std::cos(a), .5 * std::sin(a), 0};
      const double mean = t * of_light(row) + 50;
      out.data.push_back({mean + std::sqrt(mean) * draws.normal(), 50, 100, 1, row});
      out.places.push_back({step_s * k, k, flicker * (1 + k % 3)});
    }
  }
  return out;
}

Counted shuffled(const Counted &in) {
  std::vector<std::size_t> order(in.data.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::shuffle(order, std::mt19937_64(3));
  Counted out;
  for (const std::size_t k : order) {
    out.data.push_back(in.data[k]);
    out.places.push_back(in.places[k]);
  }
  return out;
}

/// Of logarithms, all counts by all: e^(-|dt|/tau) of a cloud, and flicker within an exposure, or
/// of each count.
Eigen::MatrixXd covariance_of(const Counted &c, bool is_apart, const CloudPrior &cloud) {
  const auto n = static_cast<Eigen::Index>(c.places.size());
  Eigen::MatrixXd out(n, n);
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b < n; ++b) {
      const AirPlace &one = c.places[static_cast<std::size_t>(a)],
                     &other = c.places[static_cast<std::size_t>(b)];
      const double dt = std::abs(one.time_s - other.time_s);
      const double kept = dt == 0 ? 1 : cloud.time_s > 0 ? std::exp(-dt / cloud.time_s) : 0;
      const bool is_shared = is_apart ? a == b : one.exposure == other.exposure;
      out(a, b) = cloud.sd * cloud.sd * kept + (is_shared ? one.flicker * other.flicker : 0);
    }
  return out;
}

struct AirCase {
  double flicker;
  bool is_apart;
  CloudPrior cloud;
};
const std::vector<AirCase> cases{{0, false, {.1, 0}},    {0, false, {.1, 60}},
                                 {.02, false, {}},       {.02, true, {}},
                                 {.02, false, {.1, 60}}, {.02, true, {.1, 1e4}}};

/// As with a common error for each column of a root of the whole covariance.
TEST(OpenAir, ItsFitIsThatOfTheWholeMatrix) {
  for (const AirCase &one : cases) {
    const Counted c = shuffled(two_beams(12, 10, one.flicker));
    const auto n = static_cast<Eigen::Index>(c.data.size());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
        covariance_of(c, one.is_apart, one.cloud));
    std::vector<CommonError> own{{std::vector<double>(c.data.size(), 0), .01}}, all;
    for (std::size_t k = 0; k < c.data.size(); k += 2)
      own[0].effect[k] = of_light(c.data[k].row); // a gain
    all = own;
    for (Eigen::Index k = 0; k < n; ++k) {
      CommonError column{{}, std::sqrt(std::max(0., solver.eigenvalues()(k)))};
      for (Eigen::Index r = 0; r < n; ++r)
        column.effect.push_back(of_light(c.data[static_cast<std::size_t>(r)].row) *
                                solver.eigenvectors()(r, k));
      all.push_back(std::move(column));
    }
    const auto whole = fit_stokes(c.data, 3, all);
    const auto fit = fit_stokes(c.data, 3, own, OpenAir(c.places, one.is_apart, one.cloud), light);
    ASSERT_TRUE(whole && fit);
    // Eigenvalues know 1e-15 of the largest: 1e-17 beside the 1e-6 of photons, through 1e4 of them.
    constexpr double digits = 1e-7;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(fit->stokes[k] / whole->stokes[k], 1, digits);
      for (std::size_t l = 0; l < 3; ++l)
        EXPECT_NEAR(fit->covariance[k][l], whole->covariance[k][l],
                    digits * std::sqrt(whole->covariance[k][k] * whole->covariance[l][l]));
    }
    EXPECT_NEAR(fit->chi2 / whole->chi2, 1, digits);
    EXPECT_NEAR(fit->minus_2_log_likelihood, whole->minus_2_log_likelihood, 1e-5);
  }
}

/// Where a posterior is highest, the step from its mean is the prior's covariance times the slope
/// of the likelihood; the mean transparency of the prior is 1.
TEST(OpenAir, TransparenciesAreTheMostLikelyOnes) {
  for (const AirCase &one : cases) {
    const Counted c = shuffled(two_beams(12, 10, one.flicker));
    const OpenAir air(c.places, one.is_apart, one.cloud);
    const auto t = air.transparencies(c.data, light);
    const auto n = static_cast<Eigen::Index>(t.size());
    Eigen::VectorXd slope(n), step(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double m = t[i] * of_light(c.data[i].row), flicker = c.places[i].flicker;
      slope(k) = m * (c.data[i].counts - c.data[i].sky - m) / (m + c.data[i].sky + 100);
      step(k) = std::log(t[i]) + (one.cloud.sd * one.cloud.sd + flicker * flicker) / 2;
      EXPECT_NEAR(air.mean_logarithm(i), std::log(t[i]) - step(k), 1e-14);
    }
    // Digits that are left of steps of some hundredths: slopes are differences of 1e6.
    EXPECT_LT((covariance_of(c, one.is_apart, one.cloud) * slope - step).cwiseAbs().maxCoeff(),
              1e-7);
  }
}

/// Twenty thousand counts, whose matrix would have 3.2 GB.
TEST(OpenAir, ManyExposuresTakeNoLonger) {
  const Counted c = two_beams(10'000, 1, .02);
  const auto begun = std::chrono::steady_clock::now();
  const OpenAir air(c.places, false, {.1, 60});
  EXPECT_EQ(air.transparencies(c.data, light).size(), c.data.size());
  const auto fit = fit_stokes(c.data, 3, {}, air, light);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->stokes[1] / fit->stokes[0], .3, .001);
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(10)); // .1 s
}

TEST(OpenAir, WhatIsKnownIsTold) {
  const std::vector<AirPlace> places{{0, 0, 0}, {1, 1, .1}};
  EXPECT_TRUE(OpenAir(std::span(places).first(1), false, {0, 60}).is_known());
  EXPECT_FALSE(OpenAir(std::span(places).first(1), false, {.1, 60}).is_known());
  EXPECT_FALSE(OpenAir(places, false, {}).is_known());
}

} // namespace
} // namespace umov
