// Chains that were drawn once, asked for the light of other materials: without new rays.

#include "light/tests/chain_cases.h"

namespace umov {
namespace {

using namespace cases;

std::shared_ptr<const Integrator> drawn_for(const Scene &scene, std::vector<Scene> also = {}) {
  return std::make_shared<const Integrator>(scene, nullptr, ChainSharing{std::move(also), nullptr});
}
Integrator taking(const Scene &scene, const std::shared_ptr<const Integrator> &elder) {
  return Integrator(scene, nullptr, {{}, elder});
}
std::vector<Pose> poses_into_corner(std::uint64_t count) {
  std::vector<Pose> out;
  for (std::uint64_t i = 0; i < count; ++i)
    out.push_back(into_corner(i));
  return out;
}

// Equation 1 of bounces.md: with Lambert's f = rho/pi at both surfaces the light of two is in
// proportion to rho1 rho2.
TEST(ChainMaterials, LambertsLawScalesWithTheAlbedos) {
  const auto plates = [](double floor, double wall) {
    return scene_of(corner(), NormalMode::Flat, {grey(floor), grey(wall)});
  };
  const auto elder = drawn_for(plates(0.6, 0.5));
  const std::vector<Pose> poses = poses_into_corner(6);
  const std::vector<double> direct(3 * poses.size());
  const auto before = elder->indirect(poses, direct, by_chains(2), 1);
  for (const auto &[floor, wall] : {std::pair{0.9, 0.15}, std::pair{0.05, 1.0}}) {
    const Integrator other = taking(plates(floor, wall), elder);
    ASSERT_TRUE(other.takes_chains(2, 0));
    const auto after = other.indirect(poses, direct, by_chains(2), 1);
    const double times = floor * wall / (0.6 * 0.5);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      ASSERT_GT(before[k].bands[1].stokes.i, 0);
      // The same chains: sums of single precision.
      EXPECT_NEAR(after[k].bands[1].stokes.i, times * before[k].bands[1].stokes.i,
                  1e-5 * times * before[k].bands[1].stokes.i);
    }
  }
}

// bounces_test.cpp has the formula: J_k = phi rho^k (1 - f)^(k - 2) A_hole cos v / (pi A), of a
// cavity of another albedo than the one for which chains were drawn.
TEST(ChainMaterials, AWhiteCavityIsPaintedGrey) {
  const Cavity c = cavity(5'000, 50);
  Material nothing = builtin_material("paper_spectralon").value();
  nothing.body.reset();
  const auto painted = [&](double rho) { return scene_of_sides(c.mesh, {nothing}, {grey(rho)}); };
  const Integrator other = taking(painted(0.5), drawn_for(painted(0.8)));
  ASSERT_TRUE(other.takes_chains(5, 0));
  const Pose pose{normalized(Vec3<Body>{0.2, 0, 1}), normalized(Vec3<Body>{-0.1, 0.2, 1})};
  const PoseResult light = other.evaluate(pose, by_chains(5));
  double expected = 0;
  for (const double k : {2.0, 3.0, 4.0, 5.0})
    expected += std::pow(0.5, k) * std::pow(1 - c.hole_area / c.whole_area, k - 2);
  expected *= dot(c.opening, pose.sun) * dot(c.opening, pose.observer) / (pi * c.whole_area);
  // Chords for arcs: 5,000 facets are 0.2 % short of the sphere, some of it per bounce.
  const double sure = light.bands[1].half_width.i / expected;
  EXPECT_NEAR(light.indirect[1].i / expected, 1, 1.5 * sure + 1e-2);
  EXPECT_LT(sure, 0.15); // more of its chains have many surfaces than an albedo of .5 would take
}

TEST(ChainMaterials, TheSameMaterialsGiveTheSameBytes) {
  const auto scene = [] {
    return scene_of(three_plates(), NormalMode::Flat,
                    {rough("paper_au", 0.25), paint(), brushed()});
  };
  const std::vector<Pose> poses = poses_into_corner(6);
  const auto elder = drawn_for(scene());
  const Integrator younger = taking(scene(), elder), alone(scene());
  ASSERT_TRUE(younger.takes_chains(4, 0));
  const auto a = younger.evaluate(poses, by_chains(4), 2),
             b = alone.evaluate(poses, by_chains(4), 1);
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (std::size_t band = 0; band < 3; ++band) {
      EXPECT_EQ(a[k].bands[band].stokes.i, b[k].bands[band].stokes.i);
      EXPECT_EQ(a[k].bands[band].stokes.v, b[k].bands[band].stokes.v);
      EXPECT_EQ(a[k].bands[band].half_width.u, b[k].bands[band].half_width.u);
    }
}

/// Of each metal another index, its lobe as it was.
Scene metals(const char *first, const char *second, const char *third) {
  return scene_of(three_plates(), NormalMode::Flat,
                  {rough(first, 0.25), rough(second, 0.2), rough(third, 0.3)});
}

/// Against paths that were drawn anew for a scene, of light by chains that were drawn for others.
void expect_as_paths(const Scene &scene, const std::shared_ptr<const Integrator> &elder) {
  const Integrator other = taking(scene, elder);
  ASSERT_TRUE(other.takes_chains(4, 0));
  const std::vector<Pose> poses = poses_into_corner(16);
  IntegrationOptions paths = by_chains(4, 2e-3);
  paths.between = BetweenMethod::Paths;
  paths.max_points = 1u << 18;
  paths.seed = 2;
  const auto a = other.evaluate(poses, by_chains(4, 1e-3), 2),
             b = Integrator(scene).evaluate(poses, paths, 2);
  std::array<double, 4> square{};
  double count = 0;
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (std::size_t band = 0; band < 3; band += 2) {
      if (!(b[k].indirect[band].i > 0.02 * b[k].bands[band].stokes.i))
        continue;
      ++count;
      add_squares(a[k].bands[band], b[k].bands[band], square);
    }
  EXPECT_GT(count, 16);
  for (const double x : square)
    EXPECT_LT(x / count, most_square);
}

TEST(ChainMaterials, OtherIndicesAgreeWithPathsDrawnForThem) {
  const auto elder = drawn_for(metals("paper_au", "paper_al", "paper_au"));
  expect_as_paths(metals("paper_al", "paper_au", "paper_asi"), elder);
}

// What scatters otherwise than all that chains were drawn for has too few of them, and draws its
// own; among those that they were drawn for it has enough.
TEST(ChainMaterials, WhatScattersOtherwiseDrawsItsOwnOrIsNamedBefore) {
  const auto with = [](const Material &material) {
    return scene_of(three_plates(), NormalMode::Flat,
                    {rough("paper_au", 0.25), material, rough("paper_al", 0.3)});
  };
  const auto elder = drawn_for(with(rough("paper_al", 0.12)));
  EXPECT_TRUE(taking(with(rough("paper_au", 0.1)), elder).takes_chains(4, 0));
  for (const Material &other : {grey(0.5), rough("paper_al", 0.04), mirror_of("paper_al")}) {
    EXPECT_FALSE(taking(with(other), elder).takes_chains(4, 0));
    EXPECT_TRUE(taking(with(other), drawn_for(with(rough("paper_al", 0.12)), {with(other)}))
                    .takes_chains(4, 0));
  }
  // The same slots on another mesh are another body.
  const Scene moved =
      scene_of(shifted(three_plates(), {0.1, 0, 0}), NormalMode::Flat,
               {rough("paper_au", 0.25), rough("paper_al", 0.2), rough("paper_al", 0.3)});
  EXPECT_FALSE(taking(moved, elder).takes_chains(4, 0));
  const auto cover = drawn_for(with(rough("paper_al", 0.2)), {with(grey(0.5)), with(paint())});
  for (const Material &member : {grey(0.5), paint()})
    expect_as_paths(with(member), cover);
}

TEST(ChainMaterials, AReserveServesOtherMetals) {
  const auto narrow = [](const char *first, const char *second) {
    return scene_of(three_plates(), NormalMode::Flat, {rough(first, 0.12), rough(second, 0.13)});
  };
  const Scene scene = narrow("paper_al", "paper_asi");
  const Integrator other = taking(scene, drawn_for(narrow("paper_au", "paper_al")));
  const std::vector<Pose> poses = poses_into_corner(24);
  IntegrationOptions chains = by_chains(3), paths = by_chains(3, 4e-3);
  chains.max_points = 1u << 18;
  paths.max_points = 1u << 17;
  paths.between = BetweenMethod::Paths;
  const auto a = other.evaluate(poses, chains, 2), b = Integrator(scene).evaluate(poses, paths, 2);
  std::array<double, 4> square{};
  double count = 0;
  for (std::size_t k = 0; k < poses.size(); ++k)
    if (b[k].indirect[1].i > 0.02 * b[k].bands[1].stokes.i) {
      ++count;
      add_squares(a[k].bands[1], b[k].bands[1], square);
    }
  EXPECT_GT(count, 12);
  for (const double x : square)
    EXPECT_LT(x, most_square * count);
}

} // namespace
} // namespace umov
