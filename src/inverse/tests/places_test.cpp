#include "inverse/places.h"

#include "inverse/tests/box_light.h"

namespace umov {
namespace {

/// The box with light of dents three degrees apart, as narrow lobes make them: where the Sun stands
/// in the body comes back in them.
bool dented(std::span<const Pose> poses, StokesTable &out) {
  constexpr double times = 2 * pi / (3 * inverse::degree);
  (void)Box()(poses, out);
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (std::size_t b = 0; b < out.bands; ++b)
      out.i[k * out.bands + b] +=
          0.3 * (2 + std::cos(times * poses[k].sun.x) + std::cos(times * poses[k].sun.y));
  return true;
}

/// Light, and once more as that of its one part.
template <bool (*light)(std::span<const Pose>, StokesTable &)>
bool with_part(std::span<const Pose> poses, StokesTable &out) {
  StokesTable all;
  (void)light(poses, all);
  out.resize(poses.size(), 2 * all.bands);
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (std::size_t b = 0; b < out.bands; ++b) {
      const std::size_t from = k * all.bands + b % all.bands;
      out.put(k, b, {{all.i[from], all.q[from], all.u[from], 0}, {}});
    }
  return true;
}

Turning turned_by(const Quaternion &q, double x, double y, double z) {
  return {turned(q, Vec3<Body>{x, y, z}), {}};
}

TEST(Places, AFitOfPartsLeavesItsDentForADeeperOneNearby) {
  ObservedCurve curve = pass(24);
  const Quaternion truth = turned({}, Vec3<Body>{0.3, 0.5, 0.7});
  observe(curve, dented, {truth, {}}, 100, 1);
  const CurveLikelihood likelihood(curve, no_floor());
  const CurveModel known(curve, dented, {0, 1});
  const CurveModel parted(curve, with_part<dented>, {0, 1}, {{"all", 0.1, 0}});
  const std::vector<Turning> start{turned_by(truth, 0.02, 0.03, 0.02)}; // 2.4 deg
  const auto alone = inverse::first_fits(known, likelihood, start, 24, 1);
  ASSERT_EQ(alone.size(), 1u);
  EXPECT_GT(angle_between(alone[0].turning.attitude, truth), inverse::degree); // it is a dent
  const auto around = inverse::first_fits(parted, likelihood, start, 24, 1);
  ASSERT_GT(around.size(), 1u);
  EXPECT_LT(around[0].at.chi2, alone[0].at.chi2 - 20); // e^10 likelier, if not yet the truth
  EXPECT_LT(angle_between(around[0].turning.attitude, truth),
            angle_between(alone[0].turning.attitude, truth) / 2);
}

bool plain_box(std::span<const Pose> poses, StokesTable &out) { return Box()(poses, out); }

/// Light that finds the box a quarter of a turn from where it is.
bool misleading(std::span<const Pose> poses, StokesTable &out) {
  std::vector<Pose> aside(poses.begin(), poses.end());
  for (Pose &p : aside)
    for (Vec3<Body> *v : {&p.sun, &p.observer})
      *v = {v->x, -v->z, v->y};
  return Box()(aside, out);
}

TEST(Places, UnknownPartsHaveARoundOfTheirOwn) {
  ObservedCurve curve = pass(24);
  const Quaternion truth = turned({}, Vec3<Body>{0.3, 0.5, 0.7});
  observe(curve, Box(), {truth, {}}, 100, 1);
  SearchOptions options = small();
  options.errors = no_floor();
  options.starts = 500; // all that are looked at
  options.threads = 1;
  std::vector<Turning> looked_at; // the truth's neighbour as unlikely as any
  for (const Quaternion &q : attitude_grid(400))
    looked_at.push_back({q, {}});
  looked_at.push_back(turned_by(truth, 0.03, 0.03, 0.03));
  const CurveModel quick(curve, misleading, {0, 1}), known(curve, plain_box, {0, 1});
  const CurveModel parted(curve, with_part<plain_box>, {0, 1}, {{"all", 0.1, 0}});
  const auto as_told = inverse::cooled_places({known, known, quick}, looked_at, 1, options);
  ASSERT_FALSE(as_told.empty());
  EXPECT_GT(angle_between(as_told[0].attitude, truth), 20 * inverse::degree); // quick light's own
  const auto of_parts = inverse::cooled_places({parted, parted, quick}, looked_at, 1, options);
  ASSERT_FALSE(of_parts.empty());
  EXPECT_LT(angle_between(of_parts[0].attitude, truth), 2 * inverse::degree);
}

TEST(Places, DentsCrowdOutNoOtherPlace) {
  std::vector<Turning> sorted; // best first: twenty dents of one place, then one far away
  for (int k = 0; k < 20; ++k)
    sorted.push_back(turned_by({}, 0.0013 * k, 0, 0));
  sorted.push_back(turned_by({}, 0, 1, 0));
  const auto kept = inverse::apart_first(sorted, 4);
  // The places come first, beside them half of four as dents that are .3 deg from all others.
  ASSERT_EQ(kept.size(), 4u);
  EXPECT_EQ(kept[0].attitude.x, sorted[0].attitude.x);
  EXPECT_EQ(kept[1].attitude.y, sorted[20].attitude.y);
  EXPECT_EQ(kept[2].attitude.x, sorted[5].attitude.x);
  EXPECT_EQ(kept[3].attitude.x, sorted[10].attitude.x);
}

/// Twelve fits that are as good, so far from each other and so wide [rad].
std::vector<inverse::TurningFit> twelve(double apart, double sd) {
  std::vector<inverse::TurningFit> out(12);
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].turning = turned_by({}, apart * static_cast<double>(k), 0, 0);
    out[k].information = Eigen::Matrix3d::Identity() / (sd * sd);
  }
  return out;
}

TEST(Places, AreManyIfTheyAreApartAndNoBasin) {
  EXPECT_FALSE(inverse::are_many(twelve(0.003, 1e-4), 1)); // dents of one place
  EXPECT_FALSE(inverse::are_many(twelve(0.1, 0.5), 1));    // one basin
  auto apart = twelve(0.1, 1e-3);
  EXPECT_TRUE(inverse::are_many(apart, 1));
  for (std::size_t k = 9; k < apart.size(); ++k)
    apart[k].at.chi2 = 25; // e^-12.5 of the best
  EXPECT_FALSE(inverse::are_many(apart, 1));
}

} // namespace
} // namespace umov
