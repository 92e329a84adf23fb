#include "inverse/tests/box_light.h"

#include <array>
#include <cstdlib>
#include <iostream>
#include <umov/inverse/symmetry.h>

namespace umov {
namespace {

/// One of many attitudes, none of them in the grid of a search.
Quaternion any_attitude(std::uint64_t seed, std::uint64_t trial) {
  const auto u = uniform4(seed, 3, trial);
  return attitude_grid(100'003)[static_cast<std::size_t>(u[0] * 100'003)];
}

/// Light of a box that is off by a part of I, up and down as the Sun goes along its x axis.
PoseLighting off_by(double part, double frequency) {
  return [part, frequency](std::span<const Pose> poses, StokesTable &out) {
    (void)Box()(poses, out);
    for (std::size_t k = 0; k < out.i.size(); ++k)
      out.i[k] *= 1 + part * std::sin(frequency * poses[k / out.bands].sun.x);
    return true;
  };
}

TEST(PoseSearch, TheTruthIsInTheSetAsOftenAsItSays) {
  const Box box;
  int inside = 0, found = 0;
  constexpr int trials = 20;
  for (std::uint64_t t = 0; t < trials; ++t) {
    const Quaternion truth = any_attitude(99, t);
    ObservedCurve curve = pass(24);
    observe(curve, box, {truth, {}}, 30, t);
    const CurveModel model(curve, box, {0, 1});
    const auto answer = search_pose(model, small());
    ASSERT_TRUE(answer) << answer.error().text();
    inside += is_in(answer->set95, truth) ? 1 : 0;
    // The search does not miss: nothing at the truth is better than what it found.
    const CurveLikelihood likelihood(curve, small().errors);
    ASSERT_TRUE(model.for_each(std::vector<Turning>{{truth, {}}}, {}, 1,
                               [&](std::size_t, const ModelLight &light) {
                                 found += answer->chi2 < likelihood.compare(light).chi2 + 1 ? 1 : 0;
                               }));
    EXPECT_LT(answer->share_of_so3, 0.05);
  }
  // 19 of 20 are expected; 16 or fewer come in 1.6 % of such tests.
  EXPECT_GE(inside, 17);
  EXPECT_EQ(found, trials);
}

TEST(PoseSearch, RanksOfTheTruthAmongSamplesAreEven) {
  // Simulation-based calibration (Talts et al. 2018): what a posterior holds below the truth is
  // even from 0 to 1, at every level and not at 95 % alone. In density, and in a direction.
  // UMOV_RANK_TRIALS=1000, a quarter of an hour of a processor, is by hand (docs/theory/inverse.md,
  // section 7).
  const Box box;
  constexpr std::size_t bins = 5;
  const char *told = std::getenv("UMOV_RANK_TRIALS");
  const std::uint64_t trials = told ? std::strtoull(told, nullptr, 10) : 100;
  ASSERT_GE(trials, 25U) << "five a bin, for a chi-square";
  std::array<std::array<int, bins>, 2> found{};
  SearchOptions options = small();
  options.grid = 4000;
  options.starts = 160;
  options.samples = 400;
  options.errors.zero_point_sd =
      1e-4; // the data have none: told more, the truth would be too dense
  for (std::uint64_t t = 0; t < trials; ++t) {
    const Quaternion truth = any_attitude(97, t);
    ObservedCurve curve = pass(12);
    observe(curve, box, {truth, {}}, 20, 5000 + t);
    const CurveModel model(curve, box, {0, 1});
    const auto answer = search_pose(model, options);
    ASSERT_TRUE(answer) << answer.error().text();
    const CurveLikelihood likelihood(curve, options.errors);
    double of_truth = 0;
    ASSERT_TRUE(model.for_each(std::vector<Turning>{{truth, {}}}, {}, 1,
                               [&](std::size_t, const ModelLight &light) {
                                 of_truth = likelihood.compare(light).minus_2_log;
                               }));
    const auto along = [](Quaternion q) { return rotation_from<Body, Gcrs>(q).row(0).z; };
    double denser = 0, below = 0;
    for (const PoseSample &s : answer->samples) {
      denser += s.minus_2_log < of_truth ? s.weight : 0;
      below += along(s.turning.attitude) < along(truth) ? s.weight : 0;
    }
    const auto bin = [](double rank) {
      return std::min(static_cast<std::size_t>(rank * bins), bins - 1);
    };
    ++found[0][bin(denser)];
    ++found[1][bin(below)];
  }
  for (const auto &counts : found) {
    double chi2 = 0;
    const double even = static_cast<double>(trials) / bins;
    for (const int n : counts)
      chi2 += std::pow(n - even, 2) / even;
    std::cout << "ranks: " << ::testing::PrintToString(counts) << ", chi-square " << chi2 << "\n";
    EXPECT_LT(chi2, 13.28) << ::testing::PrintToString(counts); // 1 in 100 of 4 degrees of freedom
  }
}

TEST(PoseSearch, WhereLittleLightWasSeenTheSetIsWideAndHoldsTheTruth) {
  const Box box;
  int inside = 0;
  constexpr int trials = 12;
  for (std::uint64_t t = 0; t < trials; ++t) {
    const Quaternion truth = any_attitude(98, t);
    ObservedCurve curve = pass(16);
    observe(curve, box, {truth, {}}, 2.5, t);
    const CurveModel model(curve, box, {0, 1});
    const auto answer = search_pose(model, small());
    ASSERT_TRUE(answer) << answer.error().text();
    inside += is_in(answer->set95, truth) ? 1 : 0;
  }
  // 11.4 of 12 are expected; 8 or fewer come in 0.2 % of such tests.
  EXPECT_GE(inside, 9);
}

TEST(PoseSearch, FaintLightOfFiltersInTurnRulesNothingOutEarly) {
  // One band an epoch, less light than noise in each: eight epochs of the first round say next to
  // nothing, and five attitudes of six used to be thrown away by them.
  const Box box;
  int inside = 0;
  constexpr int trials = 8;
  for (std::uint64_t t = 0; t < trials; ++t) {
    const Quaternion truth = any_attitude(101, t);
    ObservedCurve curve = pass(48);
    observe(curve, box, {truth, {}}, 0.8, t);
    std::erase_if(curve.samples, [](const ObservedSample &s) { return s.band != s.epoch % 2; });
    for (ObservedSample &s : curve.samples) // as `umov reduce` does where nothing was seen
      s.q = s.u = std::numeric_limits<double>::quiet_NaN();
    const CurveModel model(curve, box, {0, 1});
    const auto answer = search_pose(model, small());
    ASSERT_TRUE(answer) << answer.error().text();
    inside += is_in(answer->set95, truth) ? 1 : 0;
  }
  // 7.6 of 8 are expected; 5 or fewer come in 0.6 % of such tests.
  EXPECT_GE(inside, 6);
}

TEST(PoseSearch, AQuickModelSearchesAndTheModelItselfAnswers) {
  const Box box;
  const Quaternion truth = attitude_grid(100'003)[31'415];
  ObservedCurve curve = pass(24);
  observe(curve, box, {truth, {}}, 50, 1);
  const CurveModel model(curve, box, {0, 1}), quick(curve, off_by(0.01, 40), {0, 1});
  const auto answer = search_pose({model, quick, quick}, small()),
             alone = search_pose(model, small());
  ASSERT_TRUE(answer && alone);
  EXPECT_NEAR(answer->chi2, alone->chi2, 0.1); // what steps that gain less than 0.01 leave
  EXPECT_GT(quick.poses_lit(), 8'000u * 8);    // the grid's first round
}

// Steps that quick light refuses are not lit by the light of the last steps: the posterior is that
// of a search that has no other light all the same.
TEST(PoseSearch, ParticlesAreLedFromQuickLightToThePosteriorOfTheLast) {
  const Box box;
  const auto mean_along = [](const PoseAnswer &answer) {
    double sum = 0;
    for (const PoseSample &s : answer.samples)
      sum += s.weight * rotation_from<Body, Gcrs>(s.turning.attitude).row(0).z;
    return sum;
  };
  constexpr int trials = 4;
  std::size_t lit = 0;
  for (std::uint64_t t = 0; t < trials; ++t) {
    ObservedCurve curve = pass(16);
    observe(curve, box, {any_attitude(107, t), {}}, 3, t);
    const CurveModel model(curve, box, {0, 1}), quick(curve, off_by(0.8, 3), {0, 1}),
        own(curve, box, {0, 1});
    const auto answer = search_pose({model, quick, quick}, small()),
               alone = search_pose(own, small());
    ASSERT_TRUE(answer && alone);
    // Two samples of one posterior are up to .15 apart in ln evidence, and .05 in this mean.
    EXPECT_NEAR(answer->log_evidence, alone->log_evidence, 0.25);
    EXPECT_NEAR(mean_along(*answer), mean_along(*alone), 0.08);
    lit += model.poses_lit();
  }
  EXPECT_LT(lit, 700'000U); // 814,000 where every step is lit
}

TEST(PoseSearch, AlongTheValleyOfAGlintTheSearchGoesToTheEnd) {
  // A mirror a thousand times as bright as the rest holds two directions a hundred times better
  // than the third: the fit has to follow a valley that bends.
  const PoseLighting mirror = [](std::span<const Pose> poses, StokesTable &out) {
    const Box box;
    (void)box(poses, out);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const Vec3<Body> half = normalized(poses[k].sun + poses[k].observer);
      for (std::size_t b = 0; b < 2; ++b)
        out.i[k * out.bands + b] += 2000 * std::pow(std::max(0.0, half.x), 400);
    }
    return true;
  };
  SearchOptions options = small();
  options.errors.floor = 0.02;
  for (std::uint64_t t = 0; t < 8; ++t) {
    ObservedCurve curve = pass(24);
    // +X of the body near the bisector in the middle of the pass, any turn about it.
    const Vec3<Gcrs> half = normalized(curve.epochs[12].to_sun + curve.epochs[12].to_observer);
    const Vec3<Body> axis = normalized(Vec3<Body>{0, -half.z, half.y});
    Quaternion truth = turned({}, axis * std::acos(half.x));
    const double off = dot(rotation_from<Body, Gcrs>(truth) * half, Vec3<Body>{1, 0, 0});
    if (off < 0.99)
      truth = turned({}, axis * -std::acos(half.x));
    truth = turned(truth, Vec3<Body>{0.7 * static_cast<double>(t), 0, 0});
    observe(curve, mirror, {truth, {}}, 50, t);
    const CurveModel model(curve, mirror, {0, 1});
    const auto answer = search_pose(model, options);
    ASSERT_TRUE(answer) << answer.error().text();
    const CurveLikelihood likelihood(curve, options.errors);
    ASSERT_TRUE(model.for_each(std::vector<Turning>{{truth, {}}}, {}, 1,
                               [&](std::size_t, const ModelLight &light) {
                                 EXPECT_LT(answer->chi2, likelihood.compare(light).chi2 + 1) << t;
                               }));
    EXPECT_TRUE(answer->is_settled) << t;
  }
}

TEST(PoseSearch, ABodyAtRestThatTakesManyStepsIsNoBodyThatTurns) {
  // Quick light of the body half a radian turned: three steps, each .15 rad at most, do not reach
  // the truth from what it finds, which is a hundred standard deviations off at S/N 1000.
  const Box box;
  const PoseLighting turned_box = [&](std::span<const Pose> poses, StokesTable &out) {
    std::vector<Pose> seen(poses.begin(), poses.end());
    const double c = std::cos(0.5), s = std::sin(0.5);
    for (Pose &p : seen)
      for (Vec3<Body> *const v : {&p.sun, &p.observer})
        *v = {c * v->x - s * v->y, s * v->x + c * v->y, v->z};
    return box(seen, out);
  };
  SearchOptions options = small();
  for (std::uint64_t t = 0; t < 4; ++t) {
    ObservedCurve curve = pass(40);
    observe(curve, box, {any_attitude(103, t), {}}, 1000, t);
    const CurveModel model(curve, box, {0, 1}), quick(curve, turned_box, {0, 1});
    const auto chi2 = least_chi2_at_rest({model, model, quick}, options);
    ASSERT_TRUE(chi2) << chi2.error().text();
    // 80 rows of I, q and u: the mean of 240 squares scatters by .09 about 1.
    EXPECT_LT(*chi2 / static_cast<double>(3 * curve.samples.size()), 2) << t;
  }
}

TEST(PoseSearch, OneEpochNeverTellsItsReciprocalTwin) {
  const Box box;
  ObservedCurve curve = pass(1);
  const Quaternion truth = turned({}, {0.4, -0.9, 0.3});
  observe(curve, box, {truth, {}}, 100, 5);
  const CurveModel model(curve, box, {0, 1});
  const auto answer = search_pose(model, small());
  ASSERT_TRUE(answer) << answer.error().text();
  // Half a turn about the bisector swaps Sun and observer: the same light (reciprocity).
  const auto body = rotation_from<Body, Gcrs>(truth);
  const Vec3<Body> half =
      normalized(body * curve.epochs[0].to_sun + body * curve.epochs[0].to_observer);
  const Quaternion twin = turned(truth, half * pi);
  EXPECT_TRUE(answer->is_broad);
  EXPECT_GT(answer->evidences_apart, 0);
  EXPECT_LT(answer->evidences_apart, alike_evidences);
  EXPECT_TRUE(is_in(answer->set95, truth));
  EXPECT_TRUE(is_in(answer->set95, twin));
}

TEST(PoseSearch, ABodyThatShinesAlikeFromEverySideTellsNothing) {
  const PoseLighting sphere = [](std::span<const Pose> poses, StokesTable &out) {
    out.resize(poses.size(), 2);
    for (std::size_t k = 0; k < poses.size(); ++k)
      for (std::size_t b = 0; b < 2; ++b)
        out.put(k, b, {{2 + cos_phase(poses[k]), 0.1, 0, 0}, {}});
    return true;
  };
  ObservedCurve curve = pass(12);
  observe(curve, sphere, {}, 50, 1);
  const CurveModel model(curve, sphere, {0, 1});
  const auto answer = search_pose(model, small());
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_TRUE(answer->is_broad);
  EXPECT_GT(answer->share_of_so3, 0.5);
  // All attitudes are alike: no run can find more than another, but for how it is drawn.
  EXPECT_LT(answer->evidences_apart, 0.1);
  const auto symmetries = find_symmetries(sphere, 1);
  ASSERT_EQ(symmetries.size(), 3u);
  EXPECT_EQ(symmetries[0].text, "any turn about +X");
}

TEST(PoseSearch, SymmetriesOfABody) {
  EXPECT_TRUE(find_symmetries(Box(), 1).empty());
  const auto cube = find_symmetries(Box(true), 1);
  ASSERT_EQ(cube.size(), 9u); // quarter, half and three quarters about each axis
  EXPECT_EQ(cube[1].text, "half turn about +X");
}

TEST(PoseSearch, TheAnswerDoesNotDependOnThreads) {
  const Box box;
  ObservedCurve curve = pass(10);
  observe(curve, box, {turned({}, {1, 0.5, -0.2}), {}}, 30, 3);
  SearchOptions options = small();
  options.threads = 1;
  const CurveModel model(curve, box, {0, 1});
  const auto one = search_pose(model, options);
  options.threads = 3;
  const auto three = search_pose(model, options);
  ASSERT_TRUE(one && three);
  ASSERT_EQ(one->samples.size(), three->samples.size());
  EXPECT_EQ(one->log_evidence, three->log_evidence);
  EXPECT_EQ(one->samples.back().minus_2_log, three->samples.back().minus_2_log);
}

TEST(PoseSearch, WhenItExplainsNothing) {
  PoseAnswer answer;
  answer.measurements = 104;
  answer.unknowns = 4;
  answer.misfit = 199; // of 100, whose deviation is sqrt(200) = 14: unlikely, and less than twice
  EXPECT_FALSE(explains_nothing(answer, 0.02));
  answer.misfit = 201;
  EXPECT_TRUE(explains_nothing(answer, 0.02));
  answer.measurements = 9; // 11 of 5: 5 % by chance
  answer.misfit = 11;
  EXPECT_FALSE(explains_nothing(answer, 0.02));
  answer.model_error = 0.081;
  EXPECT_TRUE(explains_nothing(answer, 0.02));
  EXPECT_FALSE(explains_nothing(answer, 0.03));
  answer.model_error = 0.019;
  EXPECT_FALSE(explains_nothing(answer, 0.001)); // of .005 at least
}

TEST(PoseSearch, WhereNothingFitsNoParticlesAreFollowed) {
  // Light that goes up and down by three from one epoch to the next, as no box's does: many bad
  // fits, of which none stands out.
  ObservedCurve curve = pass(24);
  observe(curve, Box(), {any_attitude(5, 1), {}}, 100, 3);
  for (ObservedSample &s : curve.samples)
    s.i *= s.epoch % 2 == 0 ? 3 : 1;
  SearchOptions options = small();
  options.errors.has_polarization = false;
  options.largest_floor = 0.1;
  const auto answer = search_pose(CurveModel(curve, Box(), {0, 1}), options);
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_TRUE(explains_nothing(*answer, options.errors.floor));
  EXPECT_FALSE(answer->is_broad);
  EXPECT_FALSE(answer->modes.empty());
}

TEST(PoseSearch, NothingMeasuredIsSaid) {
  ObservedCurve curve = pass(3);
  const CurveModel model(curve, Box(), {0, 1});
  const auto answer = search_pose(model, small());
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::BadInput);
}

/// A body that looks alike after every sixteenth of a turn about its axis, and upside down.
bool flower(std::span<const Pose> poses, StokesTable &out) {
  out.resize(poses.size(), 2);
  const auto seen = [](const Vec3<Body> &v) {
    const double across = v.x * v.x + v.y * v.y;
    return 0.3 + across * (1 + 0.4 * across * across * std::cos(16 * std::atan2(v.y, v.x)));
  };
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (std::size_t b = 0; b < 2; ++b)
      out.put(k, b, {{seen(poses[k].sun) * seen(poses[k].observer), 0, 0, 0}, {}});
  return true;
}

// Thirty-two attitudes give the same light; two dozen fits, as are taken to the end at first, can
// hold no more than so many of them.
TEST(PoseSearch, MoreAreSoughtWhereManyAttitudesAreAlike) {
  const Turning truth{turned(turned({}, {0.4, 0, 0}), {0, -0.7, 0.3}), {}};
  ObservedCurve curve = pass(40);
  observe(curve, flower, truth, 100, 3);
  const CurveModel model(curve, flower, {0, 1});
  const auto answer = search_pose(model, small());
  ASSERT_TRUE(answer) << answer.error().text();
  constexpr double near = 0.03; // rad: a tenth of a petal
  int found = 0;
  for (int side = 0; side < 2; ++side)
    for (int petal = 0; petal < 16; ++petal) {
      const Quaternion q =
          turned(turned(truth.attitude, {side * pi, 0, 0}), {0, 0, petal * pi / 8});
      found += std::ranges::any_of(answer->modes,
                                   [&](const PoseMode &mode) {
                                     return angle_between(mode.turning.attitude, q) < near;
                                   })
                   ? 1
                   : 0;
    }
  EXPECT_EQ(found, 32);
}

} // namespace
} // namespace umov
