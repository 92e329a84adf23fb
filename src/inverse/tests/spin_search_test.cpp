#include "inverse/some_epochs.h"
#include "inverse/tests/box_light.h"

#include <umov/inverse/direction_table.h>
#include <umov/inverse/spin_search.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

TEST(DirectionTable, IsNearTheLightBetweenItsNodes) {
  const Box box;
  const auto table = DirectionTable::make(box, 36, 0, 2);
  ASSERT_TRUE(table);
  const auto coarse = DirectionTable::lighting(table, 2);
  std::vector<Pose> poses;
  for (std::uint64_t k = 0; k < 500; ++k)
    poses.push_back(random_pose(1, k, Angle::degrees(20 + 0.28 * static_cast<double>(k))));
  StokesTable exact, looked_up;
  ASSERT_TRUE(box(poses, exact) && coarse(poses, looked_up));
  std::vector<double> off;
  for (std::size_t k = 0; k < exact.i.size(); ++k)
    off.push_back(std::abs(looked_up.i[k] - exact.i[k]) / (exact.i[k] + 0.1));
  std::ranges::sort(off);
  // 5 deg of a lobe 20 deg wide bend by a few per cent; edges of faces are kinks.
  EXPECT_LT(off[off.size() / 2], 0.02);
  EXPECT_LT(off[off.size() * 9 / 10], 0.1);
}

TEST(DirectionTable, HalfOfItsNodesAreATableOfItsOwn) {
  const Box box;
  const auto table = DirectionTable::make(box, 36, 0, 2), few = DirectionTable::make(box, 18, 0, 2);
  ASSERT_TRUE(table && few);
  const auto half = table->halved();
  ASSERT_TRUE(half) << half.error().text();
  std::vector<Pose> poses;
  for (std::uint64_t k = 0; k < 200; ++k)
    poses.push_back(random_pose(2, k, Angle::degrees(20 + 0.7 * static_cast<double>(k))));
  StokesTable halved, made;
  ASSERT_TRUE(DirectionTable::lighting(*half, 2)(poses, halved) &&
              DirectionTable::lighting(few, 2)(poses, made));
  for (std::size_t k = 0; k < made.i.size(); ++k) {
    EXPECT_NEAR(halved.i[k], made.i[k], 1e-5); // floats of I up to 2
    EXPECT_NEAR(halved.q[k], made.q[k], 1e-5);
  }
}

TEST(DirectionTable, AnOddNumberOfCellsHasNoHalf) {
  const auto table = DirectionTable::make(Box(), 7, 0, 1);
  ASSERT_TRUE(table);
  const auto half = table->halved();
  ASSERT_FALSE(half);
  EXPECT_EQ(half.error().code, ErrorCode::BadInput);
}

/// One period, no alias, any axis; a table of `coarse` light for the first looks.
SpinRequest one_period(double period_s, const PoseLighting &coarse) {
  SpinRequest out;
  out.periods_s = {period_s};
  out.coarse = DirectionTable::lighting(DirectionTable::make(coarse, 24, 0, 0), 0);
  out.attitudes = 2000;
  out.axes = 100;
  return out;
}

TEST(SpinSearch, PeriodAxisAndAttitudeComeBack) {
  const Box box;
  const auto table = DirectionTable::make(box, 24, 0, 0);
  const auto half = table->halved();
  ASSERT_TRUE(half) << half.error().text();
  const PoseLighting slightly_off = [&](std::span<const Pose> poses, StokesTable &out) {
    const bool is_whole = box(poses, out);
    for (std::size_t k = 0; k < out.i.size(); ++k)
      out.i[k] *= 1 + 0.03 * std::sin(9 * poses[k / out.bands].sun.x);
    return is_whole;
  };
  int found = 0;
  constexpr int trials = 1;
  for (std::uint64_t t = 0; t < trials; ++t) {
    const auto u = uniform4(5, 1, t);
    const Vec3<Body> axis = normalized(Vec3<Body>{u[0] - .5, u[1] - .5, u[2] - .5});
    const double period = 60;
    const Turning truth{attitude_grid(1009)[static_cast<std::size_t>(u[3] * 1009)],
                        axis * (2 * pi / period)};
    ObservedCurve curve = pass(80); // 800 s
    observe(curve, box, truth, 50, t);
    SpinRequest request;
    request.periods_s = {period * 1.01, period * 2.02};
    request.coarse = DirectionTable::lighting(table, 0);
    request.coarsest = DirectionTable::lighting(*half, 0);
    request.first = slightly_off;
    request.attitudes = 2000; // x 100: more than are left after the first epochs
    request.axes = 100;
    SearchOptions options = small();
    const auto answer = search_spin(curve, box, {0, 1}, request, options);
    ASSERT_TRUE(answer) << answer.error().text();
    const PoseMode &best = answer->pose.modes.front();
    const Vec3<Body> off = best.turning.rate_rad_s - truth.rate_rad_s;
    const bool is_right = angle_between(best.turning.attitude, truth.attitude) < 5 * pi / 180 &&
                          norm(off) < 0.01 * norm(truth.rate_rad_s);
    found += is_right ? 1 : 0;
    if (is_right) {
      EXPECT_NEAR(answer->periods.front().period_s, period, 0.3);
      EXPECT_EQ(answer->periods.front().tried, 0u); // not the alias
      EXPECT_EQ(best.covariance.size(), 36u);
    }
  }
  EXPECT_EQ(found, trials);
}

TEST(SpinSearch, PlacesThatCoarseLightPrefersDoNotCrowdOutTheTruth) {
  // Coarse light of a box whose colours are alike, and a little the wrong way round: it finds 24
  // spins, the turns of a cube, of which the true one is among the worst.
  const Box box, plain(true);
  const auto mixed = [&](double share) -> PoseLighting {
    return [&box, &plain, share](std::span<const Pose> poses, StokesTable &out) {
      StokesTable own;
      const bool is_whole = box(poses, own) && plain(poses, out);
      for (std::size_t k = 0; k < out.i.size(); ++k)
        out.i[k] = std::max(0.0, (1 - share) * out.i[k] + share * own.i[k]);
      return is_whole;
    };
  };
  const PoseLighting body = mixed(0.3), other_colours = mixed(-0.05);
  const double period = 60;
  const Turning truth{attitude_grid(1009)[100],
                      normalized(Vec3<Body>{0.5, 0.7, -0.3}) * (2 * pi / period)};
  ObservedCurve curve = pass(80);
  observe(curve, body, truth, 50, 6);
  const SpinRequest request = one_period(period * 1.01, other_colours);
  const auto answer = search_spin(curve, body, {0, 1}, request, small());
  ASSERT_TRUE(answer) << answer.error().text();
  const Turning &best = answer->pose.modes.front().turning;
  // As in PeriodAxisAndAttitudeComeBack: the nearest of the others is a quarter turn away.
  EXPECT_LT(angle_between(best.attitude, truth.attitude), 5 * pi / 180);
  EXPECT_LT(norm(best.rate_rad_s - truth.rate_rad_s), 0.01 * norm(truth.rate_rad_s));
}

TEST(SpinSearch, TurnsInAPauseBetweenPassesAreCounted) {
  // 400 s, and 400 s again after eleven hours of 660 turns: the first pass leaves their number
  // open.
  const Box box;
  const double period = 60;
  const Turning truth{attitude_grid(1009)[77],
                      normalized(Vec3<Body>{0.3, -0.8, 0.4}) * (2 * pi / period)};
  ObservedCurve curve = pass(40);
  ObservedCurve later = pass(38);
  for (ObservedEpoch &epoch : later.epochs) {
    epoch.seconds += 40'000;
    epoch.to_observer = normalized(epoch.to_observer + Vec3<Gcrs>{0, 0, 0.8});
    curve.epochs.push_back(epoch);
  }
  observe(curve, box, truth, 50, 3);
  const SpinRequest request = one_period(period * 1.01, box);
  const auto answer = search_spin(curve, box, {0, 1}, request, small());
  ASSERT_TRUE(answer) << answer.error().text();
  const PoseMode &best = answer->pose.modes.front();
  // S/N 50 and 156 rows tell phases to a degree: a turn more or less would be 1.5e-3 of the rate.
  EXPECT_LT(angle_between(best.turning.attitude, truth.attitude), 3 * pi / 180);
  EXPECT_NEAR(norm(best.turning.rate_rad_s) / norm(truth.rate_rad_s), 1, 2e-5);
}

TEST(SpinSearch, AFewEpochsSeeABodyFromAllSidesWhateverItsPeriod) {
  // Sixty epochs in even steps of 1,181, at 2 s: every twentieth, one phase of a turn in 40 s.
  constexpr std::size_t count = 60;
  for (const std::size_t epochs : {61u, 100u, 1181u, 1200u, 5000u})
    for (const std::size_t turn : {10u, 20u, 40u, 60u}) {
      const auto some = inverse::epochs_out_of_step(epochs, count);
      ASSERT_EQ(some.size(), count);
      EXPECT_LT(some.back(), epochs);
      std::vector<int> seen(5); // fifths of a turn; 12 of each are even
      for (std::size_t k = 0; k < count; ++k) {
        EXPECT_TRUE(k == 0 || some[k] > some[k - 1]) << epochs;
        ++seen[some[k] % turn * 5 / turn];
      }
      // Chance would leave fewer than 4 in one of the five 1 time in 200.
      EXPECT_GE(*std::ranges::min_element(seen), 4) << epochs << " " << turn;
    }
  EXPECT_EQ(inverse::epochs_out_of_step(3, count), (std::vector<std::size_t>{0, 1, 2}));
}

TEST(SpinSearch, WithoutAPeriodThereIsNone) {
  const auto answer = search_spin(pass(4), Box(), {0, 1}, SpinRequest(), SearchOptions());
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::BadInput);
}

} // namespace
} // namespace umov
