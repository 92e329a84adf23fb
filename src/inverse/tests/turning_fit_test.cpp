#include "inverse/turning_fit.h"

#include "inverse/tests/box_light.h"

namespace umov {
namespace {

/// Of a mirror, along no axis of the body: what a step along one does to it is nothing alone.
const Vec3<Body> normal = normalized(Vec3<Body>{1, 1, 1});

/// The box with one mirror more: a glint many times as bright as all else, by which two directions
/// of an attitude are known to 1e-5 and the turn about the mirror's normal by the rest.
bool mirroring(std::span<const Pose> poses, StokesTable &out) {
  (void)Box()(poses, out);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Vec3<Body> half = normalized(poses[k].sun + poses[k].observer);
    for (std::size_t b = 0; b < out.bands; ++b)
      out.i[k * out.bands + b] += 300 * std::pow(std::max(0.0, dot(half, normal)), 60);
  }
  return true;
}

/// An attitude in which the mirror turns the Sun to the observer at an epoch.
Quaternion glinting_at(const ObservedEpoch &epoch) {
  const Vec3<Gcrs> half = normalized(epoch.to_sun + epoch.to_observer);
  Quaternion best{};
  double most = -1;
  for (const Quaternion &q : attitude_grid(100'000))
    if (const double x = dot(rotation_from<Body, Gcrs>(q) * half, normal); x > most) {
      most = x;
      best = q;
    }
  return best;
}

/// A fit from there rests no higher than the truth: a minimum lies below it, and steps end where
/// three in a row gain less than .01 each.
void expect_rests_below(const Turning &truth, const Turning &start, const ObservedCurve &curve,
                        inverse::Freedom freedom) {
  const CurveModel model(curve, mirroring, {0, 1});
  const CurveLikelihood likelihood(curve, no_floor());
  const bool drops_hopeless = freedom == inverse::Freedom::AttitudeAndRate; // as a search of spins
  const auto fits = inverse::fit_turnings(model, likelihood, {start}, {},
                                          {freedom, 200, 12, 24, 1e-3, 1, drops_hopeless});
  ASSERT_EQ(fits.size(), 1u);
  EXPECT_TRUE(fits[0].is_converged);
  const auto at_truth = inverse::compare_all(model, likelihood, std::vector<Turning>{truth}, {}, 1);
  EXPECT_LT(fits[0].at.chi2, at_truth[0].chi2 + 0.1);
}

TEST(TurningFit, RestsAtTheBottomOfTheValleyOfAGlint) {
  ObservedCurve curve = pass(40);
  const Quaternion glint = glinting_at(curve.epochs[20]);
  for (int k = 0; k < 6; ++k) {
    SCOPED_TRACE(k);
    const Quaternion truth = turned(glint, normal * k);
    observe(curve, mirroring, {truth, {}}, 100, static_cast<std::uint64_t>(k));
    // Up the valley: the normal of the mirror stays where it is.
    const Quaternion start = turned(truth, normal * (k % 2 == 0 ? 0.1 : -0.1));
    expect_rests_below({truth, {}}, {start, {}}, curve, inverse::Freedom::Attitude);
  }
}

TEST(TurningFit, OfASpinRestsAtTheBottomToo) {
  ObservedCurve curve = pass(40);
  const Quaternion glint = glinting_at(curve.epochs[20]);
  inverse::Step off(6);
  off << 0.003, -0.002, 0.002, 0.003, 0.002, -0.002;
  for (int k = 0; k < 3; ++k) {
    SCOPED_TRACE(k);
    const Turning truth{turned(glint, normal * k), {0, 0, 2e-3}};
    observe(curve, mirroring, truth, 100, static_cast<std::uint64_t>(k));
    expect_rests_below(truth, inverse::stepped(truth, off, inverse::span_of(curve)), curve,
                       inverse::Freedom::AttitudeAndRate);
  }
}

} // namespace
} // namespace umov
