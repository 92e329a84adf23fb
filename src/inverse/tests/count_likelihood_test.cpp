#include "core/tests/anchors.h"
#include "inverse/count_likelihood.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <umov/core/quantity.h>
#include <umov/inverse/likelihood.h>

namespace umov {
namespace {

constexpr std::size_t turns = 40, channels = 4;

/// Light of a body that is turned by an angle: what is asked.
struct Light {
  std::vector<double> i, q, u;
  explicit Light(double angle) {
    for (std::size_t e = 0; e < turns; ++e) {
      const double x = static_cast<double>(e) / turns;
      i.push_back(1 + 0.6 * std::sin(5 * x + angle));
      q.push_back(0.3 * i.back() * std::cos(3 * x + 2 * angle));
      u.push_back(0);
    }
  }
  [[nodiscard]] ModelLight view() const { return {i, q, u}; }
};

/// One band, one exposure an epoch, an analyser of four angles at once: w (1, cos 2a, sin 2a)/2.
ObservedCurve exposures(double electrons, double read, std::uint64_t seed) {
  const Light truth(0);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  ObservedCurve out;
  out.bands = {"a"};
  for (std::size_t e = 0; e < turns; ++e) {
    out.epochs.emplace_back();
    double net[channels];
    for (std::size_t c = 0; c < channels; ++c) {
      const double twice = static_cast<double>(c) * pi / 2;
      ObservedCount one;
      one.epoch = e;
      one.by_i = electrons / 2;
      one.by_q = electrons / 2 * std::cos(twice);
      one.by_u = electrons / 2 * std::sin(twice);
      one.sky = 2;
      one.fixed_variance = read * read;
      const double mean = one.sky + one.by_i * truth.i[e] + one.by_q * truth.q[e];
      one.net = static_cast<double>(std::poisson_distribution<int>(mean)(random)) +
                read * normal(random) - one.sky;
      net[c] = one.net;
      out.counts.push_back(one);
    }
    // What these are reduced to: sums and differences, with variances of what was counted.
    ObservedSample s;
    s.epoch = e;
    const double sum = (net[0] + net[1] + net[2] + net[3]) / 2;
    const double variance = std::max(2 * sum, 1.0) + channels * (2 + read * read);
    s.i = sum / electrons;
    s.i_sd = std::sqrt(variance) / 2 / electrons;
    if (s.i > 3 * s.i_sd) {
      s.q = (net[0] - net[2]) / sum;
      s.u = (net[1] - net[3]) / sum;
      s.cov_qq = s.cov_uu = variance / 2 / (sum * sum);
    }
    out.samples.push_back(s);
  }
  return out;
}

struct Found {
  double angle = 0, sd = 0;
  bool has_truth = false; ///< within the 95 % of -2 ln L
};

/// By a scan; the deviation from the curvature at the best.
Found scan(const ObservedCurve &curve) {
  CurveErrors errors;
  errors.floor = errors.floor_median = 0;
  errors.zero_point_sd = 1e-6;
  const CurveLikelihood likelihood(curve, errors);
  const auto at = [&](double angle) { return likelihood.compare(Light(angle).view()).minus_2_log; };
  Found out;
  double best = at(0), step = 0.05;
  for (int halving = 0; halving < 12; ++halving, step /= 2)
    for (int k = -16; k <= 16; ++k)
      if (const double angle = out.angle + k * step, value = at(angle); value < best) {
        best = value;
        out.angle = angle;
        k = -17;
      }
  double width = 1e-4;
  while (width < 1 && at(out.angle + width) + at(out.angle - width) - 2 * best < 2)
    width *= 1.02;
  out.sd = width;
  out.has_truth = at(0) - best < 3.841; // chi-square of one number, 95 %
  return out;
}

TEST(CountLikelihood, IsTheNormalDensityWithTheModelsVariance) {
  // Two channels of one exposure by hand: C = diag(mean + v0) + (F^2 + s^2) m m^T + floor of q.
  ObservedCurve curve;
  curve.bands = {"a"};
  curve.epochs.resize(1);
  const double by_q[] = {400, -400}, off[] = {30, -10};
  for (int c = 0; c < 2; ++c) {
    ObservedCount one;
    one.by_i = 400;
    one.by_q = by_q[c];
    one.sky = 50;
    one.fixed_variance = 9;
    one.scintillation = 0.03;
    one.net = 2 * (one.by_i + 0.25 * one.by_q) + off[c];
    curve.counts.push_back(one);
  }
  CurveErrors errors;
  errors.floor = 0.04;
  errors.floor_median = 0;
  errors.zero_point_sd = 1e-6;
  const std::vector<double> i{1}, q{0.25}, u{0};
  const Comparison found = CurveLikelihood(curve, errors).compare({i, q, u});
  const double g = found.scale, m[] = {g * 500, g * 300};
  const double n[] = {1000 + off[0], 600 + off[1]};
  const double common = 0.04 * 0.04 + 0.03 * 0.03, of_q = std::pow(g * 0.02 * 400, 2);
  const double aa = m[0] + 59 + common * m[0] * m[0] + of_q;
  const double bb = m[1] + 59 + common * m[1] * m[1] + of_q;
  const double ab = common * m[0] * m[1] - of_q;
  const double det = aa * bb - ab * ab, x = n[0] - m[0], y = n[1] - m[1];
  const double chi2 = (bb * x * x - 2 * ab * x * y + aa * y * y) / det;
  // The variances are of the scale of the round before: 1e-4 of it.
  EXPECT_NEAR(found.chi2, chi2, 1e-3 * chi2);
  EXPECT_EQ(CurveLikelihood(curve, errors).measurements(), 2u);
}

TEST(CountLikelihood, AgreesWithReducedStokesParametersWhereThereIsMuchLight) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const ObservedCurve curve = exposures(2e4, 3, seed);
    ObservedCurve reduced = curve;
    reduced.counts.clear();
    const Found a = scan(curve), b = scan(reduced);
    EXPECT_NEAR(a.angle, b.angle, 0.2 * a.sd);
    EXPECT_NEAR(a.sd, b.sd, 0.05 * a.sd); // Q/I of one set and of its model: first order
  }
}

TEST(CountLikelihood, CoversWhereThereIsLittleLight) {
  // 6 electrons a channel on a sky of 2, read noise 2: S/N of an exposure 3.5 at most.
  constexpr int trials = 300;
  int inside = 0;
  double pull = 0, reduced_pull = 0;
  for (std::uint64_t seed = 0; seed < trials; ++seed) {
    ObservedCurve curve = exposures(12, 2, 100 + seed);
    const Found a = scan(curve);
    curve.counts.clear();
    const Found reduced = scan(curve);
    inside += a.has_truth ? 1 : 0;
    pull += a.angle / a.sd / trials;
    reduced_pull += reduced.angle / reduced.sd / trials;
  }
  EXPECT_NEAR(inside, 0.95 * trials, 4 * std::sqrt(0.95 * 0.05 * trials));
  EXPECT_NEAR(pull, 0, 4 / std::sqrt(trials));
  // Variances of what was counted, and no q and u of what is faint, pull: .15 +- .06 here.
  EXPECT_LT(std::abs(pull), std::abs(reduced_pull));
}

/// -2 ln L = r^T C^-1 r + ln det C of docs/theory/observing.md, 7: four analysers of extinction 300
/// and unequal gains, 40 pixels of 2.3 e and 2.6 e/ADU, sky of 120 e from 400 pixels, whose light
/// flickers together.
TEST(CountLikelihood, OfASetThatFlickersIsThatOfItsMatrix) {
  const Anchors table("observing_reduction");
  const auto of = [&](const char *name) { return table.row({name})["value"]; };
  const double counts[] = {3120, 2705, 2210, 2650}, gains[] = {.98, 1, 1.02, 1.01};
  constexpr double sky = 120, diattenuation = 299. / 301;
  ObservedCurve curve;
  curve.bands = {"a"};
  curve.epochs.emplace_back();
  for (std::size_t k = 0; k < 4; ++k) {
    const double twice = static_cast<double>(k) * pi / 2;
    ObservedCount one;
    one.by_i = gains[k] / 2;
    one.by_q = one.by_i * diattenuation * std::cos(twice);
    one.by_u = one.by_i * diattenuation * std::sin(twice);
    one.sky = sky;
    one.net = counts[k] - sky;
    one.fixed_variance = 40 * 2.3 * 2.3 + sky * 40 / 400 + 40 * 2.6 * 2.6 / 12;
    one.scintillation = .0139;
    curve.counts.push_back(one);
  }
  CurveErrors errors;
  errors.floor = errors.floor_median = 0;
  // What all channels share along the light leaves the light where it was.
  const std::vector<double> i{of("fit_I")}, q{of("fit_Q")}, u{of("fit_U")};
  const auto seen = inverse::CountLikelihood(curve, errors, i.front(), {}).whitened({i, q, u}, 1);
  double found = seen.log_det;
  for (std::size_t k = 0; k < seen.net.size(); ++k)
    found += std::pow(seen.net[k] - seen.light[k], 2);
  // No model is taken for better than 1e-4 of itself: 1e-4 of the variance.
  EXPECT_NEAR(found, of("scintillation_likelihood"), 5e-4);
}

} // namespace
} // namespace umov
