// What a curve cannot tell by itself.

#include "jobs/curve_limits.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <umov/core/quantity.h>
#include <umov/core/random.h>

namespace umov::jobs {
namespace {

double normal(std::uint64_t seed, std::uint64_t index) {
  const auto u = uniform4(seed, 17, index);
  return std::sqrt(-2 * std::log(u[0])) * std::cos(2 * pi * u[1]);
}

/// Light of constant I in two bands at 20 epochs, its scattering plane turning under the
/// instrument; q and u (in that plane) as told, each with errors of `sd` that are correlated by a
/// half.
ObservedCurve constant_light(const std::function<std::pair<double, double>(std::size_t)> &fractions,
                             double sd, std::uint64_t seed) {
  ObservedCurve out;
  out.bands = {"a", "b"};
  for (std::size_t e = 0; e < 20; ++e) {
    out.epochs.emplace_back();
    out.epochs.back().seconds = 10. * static_cast<double>(e);
    out.epochs.back().scattering_axis_rad = 0.05 * static_cast<double>(e);
    for (std::size_t b = 0; b < 2; ++b) {
      const std::uint64_t k = 3 * (2 * e + b);
      const auto [q, u] = fractions(e);
      const double x = normal(seed, k), y = normal(seed, k + 1);
      ObservedSample s;
      s.epoch = e;
      s.band = b;
      s.i_sd = 0.01;
      s.i = 1 + 0.01 * normal(seed, k + 2);
      s.q = q + sd * x;
      s.u = u + sd * (0.5 * x + std::sqrt(0.75) * y);
      s.cov_qq = s.cov_uu = sd * sd;
      s.cov_qu = 0.5 * sd * sd;
      out.samples.push_back(s);
    }
  }
  return out;
}

std::pair<double, double> same(std::size_t) { return {0.1, -0.05}; }
std::pair<double, double> turning(std::size_t e) {
  return {0.1 * std::cos(0.4 * static_cast<double>(e)),
          0.1 * std::sin(0.4 * static_cast<double>(e))};
}
/// 0.2 at 30 deg of the instrument, seen in a plane that turns.
std::pair<double, double> same_in_the_instrument(std::size_t e) {
  const double twice = 2 * (pi / 6 - 0.05 * static_cast<double>(e));
  return {0.2 * std::cos(twice), 0.2 * std::sin(twice)};
}

CurveErrors as_measured() {
  CurveErrors out;
  out.floor = out.floor_median = 0;
  return out;
}

bool says_steady(const ObservedCurve &curve) {
  const auto limits = limits_of(curve, as_measured(), Asked::Attitude);
  return std::ranges::any_of(limits, [](const std::string &text) {
    return text.find("not change by more than") != std::string::npos;
  });
}

TEST(CurveLimits, PolarizationThatChangesIsAChangeThoughBrightnessIsNone) {
  const ObservedCurve curve = constant_light(turning, 0.02, 1);
  EXPECT_FALSE(is_steady(curve, as_measured()));
  EXPECT_FALSE(says_steady(curve));
  CurveErrors bright = as_measured();
  bright.has_polarization = false; // what is not used tells nothing
  EXPECT_TRUE(is_steady(curve, bright));
  CurveErrors wrong = as_measured();
  wrong.floor_q = 0.2; // a change that the model may be wrong by
  EXPECT_TRUE(is_steady(curve, wrong));
  EXPECT_TRUE(is_steady(constant_light(turning, 0.3, 1), as_measured())); // lost in its errors
}

TEST(CurveLimits, PolarizationThatIsConstantSomewhereIsNoChange) {
  // In the plane of scattering or in the instrument. The test has a level of 1 %, which is asked of
  // brightness in two ways and of polarization in two: of 400 curves 8 and less are expected to be
  // called changing, 4 standard deviations above are 20.
  for (const auto &light : {same, same_in_the_instrument}) {
    int steady = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed)
      steady += is_steady(constant_light(light, 0.02, seed), as_measured()) ? 1 : 0;
    EXPECT_GE(steady, 380);
  }
  EXPECT_TRUE(says_steady(constant_light(same, 0.02, 1)));
}

TEST(CurveLimits, CorrelationsOfQAndUCount) {
  // A step of (d, d) between two halves of 20 samples each, without noise: each is (d, d) / 2 off
  // the mean, and errors correlated by a half have a variance of 1.5 sd^2 along that and of
  // 0.5 sd^2 across, so that chi2 = 40 (d^2 / 2) / (1.5 sd^2). It crosses the 1 % point of 76
  // degrees of freedom, 107.58 (Abramowitz & Stegun 26.4.17 gives 107.60), at d = 2.841 sd along
  // and, with 0.5 in place of 1.5, at 1.640 sd across.
  constexpr double sd = 0.02;
  for (const auto &[across, least] : {std::pair{false, 2.841}, {true, 1.640}})
    for (const auto &[part, expected] : {std::pair{0.99, true}, {1.01, false}}) {
      const double d = part * least * sd;
      ObservedCurve curve = constant_light([](std::size_t) { return std::pair(0., 0.); }, sd, 1);
      for (ObservedSample &s : curve.samples) {
        curve.epochs[s.epoch].scattering_axis_rad = 0;
        s.i = 1;
        s.q = s.epoch < 10 ? d : 0;
        s.u = across ? -s.q : s.q;
      }
      EXPECT_EQ(is_steady(curve, as_measured()), expected) << across << " " << part;
    }
}

} // namespace
} // namespace umov::jobs
