// What a search leaves out of an object's light, and what that does to its verdict.

#include "jobs/invert_between.h"

#include "jobs/invert_tables.h"
#include "jobs/tests/white_sphere.h"

#include <array>

namespace umov::jobs {
namespace {

/// A square floor of 1 m2 and a wall along its edge at x = 0.
Mesh floor_and_wall() {
  Mesh mesh;
  mesh.groups = {"sphere"}; // as the scenario's mesh
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}};
  const std::array<std::uint32_t, 3> none{no_index, no_index, no_index};
  mesh.triangles = {{{0, 1, 2}, none, 0, 0},
                    {{0, 2, 3}, none, 0, 0},
                    {{0, 3, 5}, none, 0, 0},
                    {{0, 5, 4}, none, 0, 0}};
  return mesh;
}

/// The Sun on the floor alone, the observer half-way between floor and wall.
ObservedCurve looked_at(std::size_t epochs) {
  ObservedCurve out;
  out.bands = {"nm:550"};
  for (std::size_t k = 0; k < epochs; ++k) {
    ObservedEpoch one;
    one.seconds = static_cast<double>(k);
    one.to_sun = {0, 0, 1}; // in the plane of the wall
    one.to_observer = normalized(Vec3<Gcrs>{1, 0, 1});
    out.epochs.push_back(one);
  }
  return out;
}

class LightBetween : public test::WhiteSphere {
protected:
  /// Of the scenario's object as it stands among the stars.
  std::optional<double> share(const Scenario &scenario) {
    const auto ready = prepare_light(scenario, {}, {}, diagnostics);
    EXPECT_TRUE(ready) << ready.error().text();
    const auto out = share_between(scenario, *ready, looked_at(30), {}, {}, {});
    EXPECT_TRUE(out) << out.error().text();
    return *out;
  }
  Diagnostics diagnostics;
};

TEST_F(LightBetween, IsWhatTheFormFactorSaysOfAFloorAndAWall) {
  const ObjText obj = write_obj(floor_and_wall(), "sphere", MtlUse::Named);
  ASSERT_TRUE(write_file_atomically(folder / "sphere.obj", obj.obj));
  ASSERT_TRUE(write_file_atomically(folder / "sphere.mtl", obj.mtl));
  const auto found = share(scenario({"material.white.body.reflectance=0.2"}));
  // Lambert plates of reflectance r, seen alike: the floor gives r, the wall r^2 F with F = .200044
  // (squares with a common edge: Hottel 1931), the floor once more between 0 and r^3 F^2 times 1.3.
  // Paths are good to a tenth of the light, which is that much of the share at most; they come out
  // far better.
  const double r = 0.2, form = 0.200044, wall = r * r * form;
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, wall / (r + wall), 0.15 * wall / (r + wall));
}

TEST_F(LightBetween, IsTheSameByTheTableOfAFit) {
  const ObjText obj = write_obj(floor_and_wall(), "sphere", MtlUse::Named);
  ASSERT_TRUE(write_file_atomically(folder / "sphere.obj", obj.obj));
  ASSERT_TRUE(write_file_atomically(folder / "sphere.mtl", obj.mtl));
  const auto found = share(scenario({"material.white.body.reflectance=0.2", "render.bounces=3"}));
  const double r = 0.2, wall = r * r * 0.200044; // as above; both directions are nodes of the table
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, wall / (r + wall), 0.15 * wall / (r + wall));
}

TEST_F(LightBetween, IsNothingOfABall) {
  EXPECT_EQ(share(scenario()), 0.0);
  EXPECT_EQ(share(scenario({"render.bounces=3"})), 0.0);
}

TEST(DoubtDirectLight, TakesAVerdictBackWhereItIsFarMoreThanTheFloor) {
  const auto judged = [](double share, double floor, Verdict before) {
    std::vector<std::string> notes;
    doubt_direct_light(share, floor, "it may be wrong", before, notes);
    return std::pair(before, notes.size());
  };
  using enum Verdict;
  EXPECT_EQ(judged(0.01, 0.02, Determined), std::pair(Determined, std::size_t{0}));
  EXPECT_EQ(judged(0.04, 0.02, Determined), std::pair(Determined, std::size_t{1}));
  EXPECT_EQ(judged(0.06, 0.02, Determined), std::pair(Undetermined, std::size_t{1}));
  EXPECT_EQ(judged(0.06, 0.02, Ambiguous), std::pair(Ambiguous, std::size_t{1}));
  EXPECT_EQ(judged(0.004, 0, Determined), std::pair(Determined, std::size_t{0}));
  EXPECT_EQ(judged(0, 0.02, Determined), std::pair(Determined, std::size_t{0}));
}

} // namespace
} // namespace umov::jobs
