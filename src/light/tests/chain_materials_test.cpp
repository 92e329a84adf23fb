// Chains that were drawn once, asked for the light of other materials: without new rays.

#include "light/tests/chain_cases.h"

#include <tuple>
#include <umov/core/median.h>

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

/// Light of one pose through the hole of a cavity, over what bounces_test.cpp has:
/// J_k = phi rho^k (1 - f)^(k - 2) A_hole cos v / (pi A), k = 2 ... 5.
struct Lit {
  double times = 0, half_width = 0; ///< in parts of the formula's
  bool is_taken = false;
};
Lit painted_over(const Cavity &c, double before, double after, bool is_named) {
  Material nothing = builtin_material("paper_spectralon").value();
  nothing.body.reset();
  const auto painted = [&](double rho) { return scene_of_sides(c.mesh, {nothing}, {grey(rho)}); };
  std::vector<Scene> also;
  if (is_named)
    also.push_back(painted(after));
  const Integrator other = taking(painted(after), drawn_for(painted(before), also));
  const Pose pose{normalized(Vec3<Body>{0.2, 0, 1}), normalized(Vec3<Body>{-0.1, 0.2, 1})};
  const std::vector<double> direct(3);
  const BandResult light = other.indirect({&pose, 1}, direct, by_chains(5), 2)[0].bands[1];
  double expected = 0;
  for (const double k : {2.0, 3.0, 4.0, 5.0})
    expected += std::pow(after, k) * std::pow(1 - c.hole_area / c.whole_area, k - 2);
  expected *= dot(c.opening, pose.sun) * dot(c.opening, pose.observer) / (pi * c.whole_area);
  return {light.stokes.i / expected, light.half_width.i / expected, other.takes_chains(5, 0)};
}

// Thinning keeps a chain of k surfaces in proportion to rho^k of those for whom it was drawn. Grey
// of .1 keeps a thousandth of those of five surfaces, which carry a fifth of the light of .9: a
// pose that met none of them, and many of two, had two thirds of the light and called it exact.
TEST(ChainMaterials, AWhiteCavityIsPaintedOver) {
  const Cavity c = cavity(5'000, 50);
  for (const auto &[before, after, is_named, is_taken] : {std::tuple{0.8, 0.5, false, true},
                                                          {0.6, 0.9, false, true},
                                                          {0.1, 0.9, false, false},
                                                          {0.1, 0.9, true, true}}) {
    const Lit light = painted_over(c, before, after, is_named);
    EXPECT_EQ(light.is_taken, is_taken) << before << ' ' << after;
    // Chords for arcs: 5,000 facets are 0.2 % short of the sphere, some of it per bounce.
    EXPECT_NEAR(light.times, 1, 1.5 * light.half_width + 1e-2) << before << ' ' << after;
    EXPECT_LT(light.half_width, 0.2); // of others some more than the .1 of an own drawing
  }
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
/// `tells`: what the chains' half-widths of I are at most, in the median and in parts of I.
void expect_as_paths(const Scene &scene, const std::shared_ptr<const Integrator> &elder,
                     double tells) {
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
  std::vector<double> width;
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (std::size_t band = 0; band < 3; band += 2) {
      if (!(b[k].indirect[band].i > 0.02 * b[k].bands[band].stokes.i))
        continue;
      width.push_back(a[k].bands[band].half_width.i / a[k].bands[band].stokes.i);
      add_squares(a[k].bands[band], b[k].bands[band], square);
    }
  ASSERT_GT(width.size(), 16u);
  for (const double x : square)
    EXPECT_LT(x / static_cast<double>(width.size()), most_square);
  EXPECT_LT(median_of(width), tells);
}

TEST(ChainMaterials, OtherIndicesAgreeWithPathsDrawnForThem) {
  const auto elder = drawn_for(metals("paper_au", "paper_al", "paper_au"));
  expect_as_paths(metals("paper_al", "paper_au", "paper_asi"), elder, 0.05);
}

/// Three plates, the second of a material.
Scene with(const Material &material) {
  return scene_of(three_plates(), NormalMode::Flat,
                  {rough("paper_au", 0.25), material, rough("paper_al", 0.3)});
}

// What scatters otherwise than all that chains were drawn for has too few of them, and draws its
// own; among those that they were drawn for it has enough.
TEST(ChainMaterials, WhatScattersOtherwiseDrawsItsOwnOrIsNamedBefore) {
  const auto elder = drawn_for(with(rough("paper_al", 0.12)));
  EXPECT_TRUE(taking(with(rough("paper_au", 0.1)), elder).takes_chains(4, 0));
  for (const Material &other : {grey(0.5), rough("paper_al", 0.04), mirror_of("paper_al")}) {
    EXPECT_FALSE(taking(with(other), elder).takes_chains(4, 0));
    EXPECT_TRUE(taking(with(other), drawn_for(with(rough("paper_al", 0.12)), {with(other)}))
                    .takes_chains(4, 0));
  }
  const auto cover = drawn_for(with(rough("paper_al", 0.2)),
                               {with(grey(0.5)), with(paint()), with(mirror_of("paper_al"))});
  for (const Material &member : {grey(0.5), paint(), mirror_of("paper_al")})
    expect_as_paths(with(member), cover, 0.05);
}

// A plate that was nearly black and turns white has few of the chains: of the other two it has
// many, which would tell of a small error.
TEST(ChainMaterials, OneBrightSurfaceAmongDarkOnesDrawsItsOwn) {
  const auto plates = [](double one) {
    return scene_of(three_plates(), NormalMode::Flat, {grey(one), grey(0.8), grey(0.8)});
  };
  EXPECT_FALSE(taking(plates(0.9), drawn_for(plates(0.02))).takes_chains(2, 0));
  EXPECT_TRUE(taking(plates(0.9), drawn_for(plates(0.5))).takes_chains(2, 0));
  EXPECT_TRUE(taking(plates(0.3), drawn_for(plates(0.9))).takes_chains(5, 0));
  EXPECT_FALSE(taking(plates(0.9), drawn_for(plates(0))).takes_chains(2, 0));
}

// A brushed lobe turned by a quarter of a turn is another lobe.
TEST(ChainMaterials, ADirectionIsPartOfAMaterial) {
  const auto along = [](Vec3<Body> direction) {
    Material out = brushed();
    out.distribution.parameters = {{"nu", 4}, {"nv", 200}};
    out.direction = direction;
    return scene_of(three_plates(), NormalMode::Flat, {out, grey(0.5)});
  };
  const auto elder = drawn_for(along({1, 0.3, 0}));
  EXPECT_TRUE(taking(along({1, 0.3, 0}), elder).takes_chains(4, 0));
  EXPECT_FALSE(taking(along({0.4, -1, 0.2}), elder).takes_chains(4, 0));
}

// Slots of another mesh are others, whatever they are made of.
TEST(ChainMaterials, AnotherMeshIsAnotherBody) {
  const Scene scene = with(grey(0.5));
  const auto elder = drawn_for(scene);
  Scene moved = scene, woven = scene, short_of_a_back = scene;
  moved.mesh = shifted(scene.mesh, {0.1, 0, 0});
  woven.mesh.tangents.assign(scene.mesh.triangles.size(), Vec3<Body>{1, 0, 0});
  short_of_a_back.back.pop_back();
  EXPECT_TRUE(taking(scene, elder).takes_chains(2, 0));
  EXPECT_FALSE(taking(moved, elder).takes_chains(2, 0));
  EXPECT_FALSE(taking(woven, elder).takes_chains(2, 0));
  // Nothing is drawn for what is not of this mesh.
  const ChainSharing left = without_meshes({{moved, woven, short_of_a_back, scene}, {}}, scene);
  ASSERT_EQ(left.also.size(), 1u);
  EXPECT_TRUE(left.also[0].mesh.triangles.empty());
  const std::vector<double> direct(3);
  const std::vector<Pose> poses{into_corner(3)};
  EXPECT_EQ(drawn_for(scene, {moved, short_of_a_back})
                ->indirect(poses, direct, by_chains(2), 1)[0]
                .bands[1]
                .stokes.i,
            elder->indirect(poses, direct, by_chains(2), 1)[0].bands[1].stokes.i);
}

/// Three plates at 430, 450, ... 650 nm.
Scene in_twelve_bands(const std::vector<Material> &plates) {
  std::vector<std::string> bands;
  for (int nm = 430; nm <= 650; nm += 20)
    bands.push_back("nm:" + std::to_string(nm));
  Diagnostics diagnostics;
  return make_scene(three_plates(), NormalMode::Flat, bands_from(bands).value(), plates, plates,
                    diagnostics)
      .value();
}

// Twelve bands, in one of which a body is white below a lobe that all have: there the body scatters
// beside the lobe twelve times what it does in the mean, at an albedo that is little more.
TEST(ChainMaterials, WhoIsNamedIsServedWhereBandsPeakApart) {
  const auto peaking = [](double at_nm) {
    Material out = rough("paper_au", 0.12);
    out.index = constant_index({0.2, 5});
    out.body = grey(0.3).body;
    out.body->reflectance = {{400, at_nm - 1, at_nm, at_nm + 1, 700}, {0, 0, 0.05, 0, 0}};
    return in_twelve_bands({out, out, out});
  };
  const auto elder = drawn_for(peaking(490), {peaking(570), peaking(650)});
  for (const double nm : {490.0, 570.0, 650.0})
    EXPECT_TRUE(taking(peaking(nm), elder).takes_chains(4, 0)) << nm;
}

// A plate of .06 that is .9 in the last of twelve bands: there its light is on chains 15 times as
// rare for it as those of the other two. By f^2 in the mean of all bands it would be 4.4 times.
TEST(ChainMaterials, OneBrightBandDrawsItsOwn) {
  const auto plates = [](double last) {
    Material one = grey(0.06);
    one.body->reflectance = {{400, 640, 650, 700}, {0.06, 0.06, last, last}};
    return in_twelve_bands({one, grey(0.8), grey(0.8)});
  };
  const auto elder = drawn_for(plates(0.06));
  EXPECT_TRUE(taking(plates(0.06), elder).takes_chains(2, 0));
  EXPECT_TRUE(taking(plates(0.12), elder).takes_chains(2, 0));
  EXPECT_FALSE(taking(plates(0.9), elder).takes_chains(2, 0));
}

// Candidates come in any order, and whoever is lit first draws.
TEST(ChainMaterials, WhoDrawsForAllDoesNotMatter) {
  const std::array materials{grey(0.5), rough("paper_al", 0.2), paint(), brushed()};
  std::vector<double> of_first;
  for (const std::array<std::size_t, 4> &order :
       {std::array<std::size_t, 4>{0, 1, 2, 3}, {3, 0, 1, 2}, {2, 1, 3, 0}}) {
    std::vector<Scene> also;
    for (std::size_t k = 1; k < order.size(); ++k)
      also.push_back(with(materials[order[k]]));
    const auto elder = drawn_for(with(materials[order[0]]), also);
    std::vector<double> told;
    for (const Material &material : materials) {
      const Integrator other = taking(with(material), elder);
      ASSERT_TRUE(other.takes_chains(4, 0));
      for (const PoseResult &light : other.evaluate(poses_into_corner(3), by_chains(4), 2))
        for (const BandResult &band : light.bands)
          told.insert(told.end(), {band.stokes.i, band.stokes.v, band.half_width.u});
    }
    if (of_first.empty())
      of_first = told;
    EXPECT_EQ(told, of_first);
  }
}

TEST(ChainMaterials, AStopIsHeardWhileItIsAskedWhoServes) {
  const auto elder = drawn_for(with(rough("paper_al", 0.2)), {with(grey(0.5))});
  const Integrator other = taking(with(rough("paper_au", 0.2)), elder);
  const std::atomic<bool> stopped{true};
  EXPECT_THROW((void)other.takes_chains(4, 0, &stopped), Failure); // nothing is drawn
  EXPECT_TRUE(other.takes_chains(4, 0));                           // nothing half made is left
  EXPECT_THROW((void)other.takes_chains(4, 0, &stopped), Failure); // the trial asks its chains
  // Chains of three surfaces are drawn, and nobody has asked whom they serve.
  ASSERT_TRUE(taking(with(grey(0.5)), elder).takes_chains(3, 0));
  EXPECT_THROW((void)other.takes_chains(3, 0, &stopped), Failure); // the trial is made
  EXPECT_TRUE(other.takes_chains(3, 0));
}

TEST(ChainMaterials, AReserveServesOtherMetals) {
  const auto narrow = [](const char *first, const char *second) {
    return scene_of(three_plates(), NormalMode::Flat, {rough(first, 0.12), rough(second, 0.13)});
  };
  const Scene scene = narrow("paper_al", "paper_asi");
  const Integrator other = taking(scene, drawn_for(narrow("paper_au", "paper_al")));
  ASSERT_TRUE(other.takes_chains(3, 0));
  const std::vector<Pose> poses = poses_into_corner(24);
  IntegrationOptions chains = by_chains(3), paths = by_chains(3, 4e-3);
  chains.max_points = 1u << 18;
  paths.max_points = 1u << 17;
  paths.between = BetweenMethod::Paths;
  const auto a = other.evaluate(poses, chains, 2), b = Integrator(scene).evaluate(poses, paths, 2);
  std::array<double, 4> square{};
  std::vector<double> width;
  for (std::size_t k = 0; k < poses.size(); ++k)
    if (b[k].indirect[1].i > 0.02 * b[k].bands[1].stokes.i) {
      width.push_back(a[k].bands[1].half_width.i / a[k].bands[1].stokes.i);
      add_squares(a[k].bands[1], b[k].bands[1], square);
    }
  ASSERT_GT(width.size(), 12u);
  for (const double x : square)
    EXPECT_LT(x / static_cast<double>(width.size()), most_square);
  EXPECT_LT(median_of(width), 0.05);
}

} // namespace
} // namespace umov
