// Light between surfaces by chains that are drawn once: against closed forms, and against paths.

#include "light/between/chain_surfaces.h"
#include "light/tests/chain_cases.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

namespace umov {
namespace {

using namespace cases;

TEST(Chains, WhiteCavityThroughItsHole) {
  // bounces_test.cpp has the formula: J_k = phi rho^k (1 - f)^(k - 2) A_hole cos v / (pi A).
  const Cavity c = cavity(5'000, 50);
  const double rho = 0.8, f = c.hole_area / c.whole_area;
  Material nothing = builtin_material("paper_spectralon").value();
  nothing.body.reset();
  const Integrator integrator(scene_of_sides(c.mesh, {nothing}, {grey(rho)}));
  const Pose pose{normalized(Vec3<Body>{0.2, 0, 1}), normalized(Vec3<Body>{-0.1, 0.2, 1})};
  for (const std::size_t bounces : {2u, 5u}) {
    const PoseResult light = integrator.evaluate(pose, by_chains(bounces));
    double expected = 0;
    for (std::size_t k = 2; k <= bounces; ++k)
      expected +=
          std::pow(rho, static_cast<double>(k)) * std::pow(1 - f, static_cast<double>(k) - 2);
    expected *= dot(c.opening, pose.sun) * dot(c.opening, pose.observer) / (pi * c.whole_area);
    // Chords for arcs: 5,000 facets are 0.2 % short of the sphere, some of it per bounce.
    const double sure = light.bands[1].half_width.i / expected;
    EXPECT_NEAR(light.indirect[1].i / expected, 1, 1.5 * sure + 1e-2) << bounces;
    EXPECT_LT(sure, 0.1); // 16 k chains, most of which do not end where the hole shows them
    EXPECT_LT(std::abs(light.indirect[1].q), 2e-3 * light.indirect[1].i); // Lambert: unpolarized
  }
}

TEST(Chains, TwoLambertPlatesByTheirFormFactor) {
  // As in bounces_test.cpp: 0.200044 (Siegel & Howell 2002, configuration 16).
  const double rho = 0.6;
  const Integrator plates(scene_of(corner(), NormalMode::Flat, {grey(rho)}));
  const PoseResult light = plates.evaluate({{0, 0, 1}, {1, 0, 0}}, by_chains(2, 1e-4));
  const double expected = rho * rho * 0.200044 / pi;
  EXPECT_NEAR(light.bands[1].stokes.i, expected, 2e-2 * expected);
  EXPECT_NEAR(light.bands[1].stokes.i, expected, 1.5 * light.bands[1].half_width.i);
}

TEST(Chains, SunAndObserverExchangedGiveTheSameLight) {
  // Each chain is taken from both of its ends, so reciprocity holds chain by chain: single
  // precision of some ten thousand sums. I alone: Q, U, V of sunlight there are what polarized
  // light would give in I back (Sekera 1966).
  const Integrator plates(scene_of(three_plates(), NormalMode::Flat,
                                   {rough("paper_au", 0.25), paint(), rough("paper_al", 0.15)}));
  std::size_t lit = 0;
  for (std::uint64_t i = 0; i < 12; ++i) {
    const Pose there = into_corner(i);
    const auto a = plates.evaluate(there, by_chains(4)),
               b = plates.evaluate({there.observer, there.sun}, by_chains(4));
    for (std::size_t band = 0; band < 3; ++band) {
      const auto &x = a.indirect[band], &y = b.indirect[band];
      EXPECT_NEAR(x.i, y.i, 1e-5 * x.i) << i;
      EXPECT_NEAR(a.bands[band].stokes.i, b.bands[band].stokes.i, 1e-5 * a.bands[band].stokes.i)
          << i;
      lit += x.i > 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(lit, 36u);
}

/// Mean square of the difference between chains and paths over its expected size, of I, Q, U, V.
std::array<double, 4> against_paths(const Scene &scene, std::size_t bounces, std::size_t poses) {
  const Integrator integrator(scene);
  std::vector<Pose> at;
  for (std::uint64_t i = 0; i < poses; ++i)
    at.push_back(into_corner(i));
  IntegrationOptions paths = by_chains(bounces, 2e-3);
  paths.between = BetweenMethod::Paths;
  paths.max_points = 1u << 18;
  paths.seed = 2;
  const auto b = integrator.evaluate(at, paths, 2);
  std::array<double, 4> out{};
  double count = 0;
  for (const std::uint64_t seed : {0u, 1u}) { // poses share their chains: two sets tell more
    IntegrationOptions chains = by_chains(bounces, 1e-3);
    chains.seed = seed;
    const auto a = integrator.evaluate(at, chains, 2);
    for (std::size_t k = 0; k < poses; ++k)
      for (std::size_t band = 0; band < a[k].bands.size(); band += 2) {
        if (!(b[k].indirect[band].i > 0.02 * b[k].bands[band].stokes.i))
          continue;
        ++count;
        add_squares(a[k].bands[band], b[k].bands[band], out);
      }
  }
  EXPECT_GT(count, 16);
  for (double &x : out)
    x /= count;
  return out;
}

TEST(Chains, AgreeWithPathsOnRoughMetals) {
  const auto square = against_paths(
      scene_of(three_plates(), NormalMode::Flat,
               {rough("paper_au", 0.25), rough("paper_al", 0.15), interface_of("paper_au", 60)}),
      4, 16);
  for (const double x : square)
    EXPECT_LT(x, most_square);
}

// Lobes of alpha .1 to .13: of what levels keep too few are met (box-wing of alpha .1: mean square
// 2 to 3.5 of I, Q, U, V, docs/theory/bounces.md). The reserve's chains are chosen by the light
// that they would carry, and settled by rays.
TEST(Chains, AReserveServesNarrowLobes) {
  const Scene scene =
      scene_of(three_plates(), NormalMode::Flat,
               {rough("paper_au", 0.1), rough("paper_al", 0.13), rough("paper_au", 0.12)});
  EXPECT_TRUE(ChainSurfaces(scene).are_narrow());
  const Integrator integrator(scene);
  std::vector<Pose> poses, exchanged;
  for (std::uint64_t i = 0; i < 32; ++i) {
    poses.push_back(into_corner(i));
    exchanged.push_back({poses.back().observer, poses.back().sun});
  }
  IntegrationOptions chains = by_chains(4, 5e-3), paths = by_chains(4, 4e-3);
  chains.max_points = 1u << 18;
  paths.max_points = 1u << 17;
  paths.between = BetweenMethod::Paths;
  const auto whole = integrator.evaluate(poses, chains, 2),
             drawn = integrator.evaluate(poses, paths, 2);
  std::array<double, 4> square{};
  double count = 0, chains_i = 0, paths_i = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (!(drawn[k].indirect[1].i > 0.02 * drawn[k].bands[1].stokes.i))
      continue;
    ++count;
    chains_i += whole[k].indirect[1].i;
    paths_i += drawn[k].indirect[1].i;
    add_squares(whole[k].bands[1], drawn[k].bands[1], square);
  }
  EXPECT_GT(count, 16);
  for (const double x : square)
    EXPECT_LT(x, most_square * count);
  EXPECT_NEAR(chains_i, paths_i, 0.03 * paths_i); // poses share their chains: some % each
  const auto back = integrator.evaluate(exchanged, chains, 1);
  for (std::size_t k = 0; k < poses.size(); ++k)
    EXPECT_NEAR(back[k].indirect[0].i, whole[k].indirect[0].i, 1e-5 * whole[k].indirect[0].i) << k;
  const auto part = integrator.evaluate({poses.begin() + 17, poses.end()}, chains, 1);
  for (std::size_t k = 0; k < part.size(); ++k) {
    EXPECT_EQ(part[k].bands[2].stokes.v, whole[17 + k].bands[2].stokes.v);
    EXPECT_EQ(part[k].bands[0].half_width.q, whole[17 + k].bands[0].half_width.q);
  }
}

// A million chains take as long as paths of a few dozen poses: of a job of few, whoever asks for
// how many of them at a time, paths draw all.
TEST(Chains, NoReserveIsDrawnForAHandfulOfPoses) {
  const Scene scene =
      scene_of(three_plates(), NormalMode::Flat, {rough("paper_au", 0.12), rough("paper_al", 0.1)});
  const std::vector<Pose> poses{into_corner(1), into_corner(2)};
  IntegrationOptions chains = by_chains(3, 0.02), paths = chains;
  chains.max_points = paths.max_points = 1u << 18;
  chains.poses_in_all = 20;
  paths.between = BetweenMethod::Paths;
  const Integrator integrator(scene);
  const auto few = integrator.evaluate(poses, chains, 1);
  const auto drawn = integrator.evaluate(poses, paths, 1);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_EQ(few[k].bands[1].stokes.i, drawn[k].bands[1].stokes.i);
    EXPECT_EQ(few[k].bands[0].half_width.v, drawn[k].bands[0].half_width.v);
  }
  chains.poses_in_all = 100;
  const auto many = integrator.evaluate(poses, chains, 1);
  EXPECT_NE(many[0].bands[1].stokes.i, drawn[0].bands[1].stokes.i);
}

/// A dielectric at 425 nm that grows metallic: light of two surfaces 20 times as bright at 650 nm.
Material reddening(double alpha) {
  Material out = rough("paper_au", alpha);
  out.index = tabulated_index("reddening", {425, 550, 650}, {{1.5, 0}, {1.5, 0.6}, {1.5, 1.2}});
  return out;
}

// Through a small hole of a sphere few chains are both lit and seen, and for many poses none of
// those that were settled: what they may have missed is said of each band as that band is bright
// (it was one number for all). Paths know what there was.
TEST(Chains, WhatMayBeHiddenIsSaidOfEachBand) {
  const Mesh mesh = cavity(2'000, 15).mesh;
  IntegrationOptions chains = by_chains(2), paths = by_chains(2, 0.05);
  chains.max_points = 1u << 18;
  paths.max_points = 1u << 14;
  paths.between = BetweenMethod::Paths;
  for (const auto &[material, least_ratio] :
       {std::pair{reddening(0.12), 12.0}, std::pair{rough("paper_au", 0.12), 4.0}}) {
    const Integrator integrator(scene_of(mesh, NormalMode::Flat, {material}));
    std::vector<Pose> poses, dark;
    for (std::uint64_t i = 0; i < 32; ++i) {
      const auto u = uniform4(12, 3, i);
      poses.push_back({normalized(Vec3<Body>{u[0] - 0.5, u[1] - 0.5, 0.7}),
                       normalized(Vec3<Body>{u[2] - 0.5, u[3] - 0.5, 0.7})});
    }
    // Beside so much direct light few chains are settled.
    const std::vector<double> much(3 * poses.size(), 1e6);
    std::vector<IndirectLight> told;
    const auto all = integrator.indirect(poses, much, chains, 2);
    for (std::size_t k = 0; k < poses.size(); ++k)
      if (all[k].bands[2].stokes.i == 0 && all[k].bands[2].half_width.i > 0) {
        dark.push_back(poses[k]);
        told.push_back(all[k]);
      }
    ASSERT_GE(dark.size(), 8u);
    const std::vector<double> none(3 * dark.size());
    const auto drawn = integrator.indirect(dark, none, paths, 2);
    std::array<std::size_t, 3> covered{};
    std::array<double, 3> width{};
    for (std::size_t k = 0; k < dark.size(); ++k) {
      const auto &bands = told[k].bands;
      for (std::size_t b = 0; b < 3; ++b) {
        width[b] += bands[b].half_width.i;
        covered[b] +=
            drawn[k].bands[b].stokes.i <= bands[b].half_width.i + drawn[k].bands[b].half_width.i
                ? 1
                : 0;
      }
    }
    EXPECT_GT(width[2], least_ratio * width[0]); // some of it at grazing incidence, white
    for (std::size_t b = 0; b < 3; ++b)          // of 95 % as many may lack by chance, or fewer
      EXPECT_GE(covered[b] + 2 + dark.size() / 20, dark.size()) << b;
  }
}

// Slats of .04 m that stand .12 m apart, .1 m above the floor, are finer than the ends' grids of
// directions: interpolation alone is off by more than the replicates' spread.
TEST(Chains, HalfWidthsHoldBehindNarrowSlats) {
  Mesh mesh = corner();
  for (std::size_t k = 0; k < 8; ++k) {
    const double x = 0.05 + 0.12 * static_cast<double>(k);
    mesh = joined(mesh, sheet(x, x + 0.04, 0, 1, 0.1, "slat"));
  }
  const auto square =
      against_paths(scene_of(mesh, NormalMode::Flat, {grey(0.8), rough("paper_al", 0.3)}), 3, 12);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_LT(square[k], most_square) << k;
}

// What lies within a box sees nothing of the world, and what is beside it all the same as ever.
TEST(Chains, PartsInsideOthersSendNoLight) {
  const Mesh mesh =
      joined(corner(), shifted(renamed(make_chamfered_cube(0.4, 0.02), "joint"), {0.3, 0.5, 0.1}));
  const auto square =
      against_paths(scene_of(mesh, NormalMode::Flat, {grey(0.8), rough("paper_al", 0.3)}), 3, 12);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_LT(square[k], most_square) << k;
}

TEST(Chains, AgreeWithPathsOnPaintAndBrushedMetal) {
  for (const Material &material : {paint(), brushed()}) {
    const auto square = against_paths(
        scene_of(three_plates(), NormalMode::Flat, {material, rough("paper_al", 0.2)}), 3, 8);
    // V of paint and metal is rounding where there is none.
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT(square[k], most_square) << material.distribution.model << ' ' << k;
  }
}

// A direction exactly opposite to the normal of one end, beside others that it lights: the fits of
// what a paint lets in have a pole there, which is not theirs.
TEST(Chains, LightStraightFromBehindSomeEndsIsANumber) {
  Material white = rough("paper_asi", 0.3);
  white.index = constant_index(1.5);
  white.body = BodyLobe{{{}, {0.6}}, false};
  const Integrator integrator(scene_of(box_wing(), NormalMode::Flat, {white, white, white}));
  std::vector<Pose> at;
  for (const Vec3<Body> &axis : {Vec3<Body>{1, 0, 0}, Vec3<Body>{0, 1, 0}, Vec3<Body>{0, 0, 1}})
    for (const double side : {-1.0, 1.0})
      for (const double height : {-0.64, 0.64}) {
        const Vec3<Body> other = normalized(axis * (0.6 * side) + Vec3<Body>{0.2, 0.3, height});
        at.push_back({axis * side, other});
        at.push_back({other, axis * side});
      }
  IntegrationOptions paths = by_chains(2, 2e-3);
  paths.between = BetweenMethod::Paths;
  paths.max_points = 1u << 17;
  const auto chains = integrator.evaluate(at, by_chains(2), 2),
             judge = integrator.evaluate(at, paths, 2);
  std::array<double, 4> square{};
  std::size_t lit = 0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    ASSERT_TRUE(std::isfinite(chains[k].bands[0].stokes.i)) << k;
    ASSERT_TRUE(std::isfinite(chains[k].bands[0].half_width.i)) << k;
    if (!(judge[k].indirect[0].i > 0.02 * judge[k].bands[0].stokes.i))
      continue;
    ++lit;
    add_squares(chains[k].bands[0], judge[k].bands[0], square);
  }
  EXPECT_GT(lit, 8U);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_LT(square[k] / static_cast<double>(lit), most_square) << k;
}

TEST(Chains, PathsDrawWhatGoesBetweenNarrowLobesAndMirrors) {
  const auto narrow = against_paths(
      scene_of(three_plates(), NormalMode::Flat, {rough("paper_al", 0.04), grey(0.5)}), 3, 8);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_LT(narrow[k], most_square) << k;
  const auto mirror = against_paths(
      scene_of(three_plates(), NormalMode::Flat, {mirror_of("paper_al"), grey(0.5)}), 3, 8);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_LT(mirror[k], most_square) << k;
}

// A film among much that is wide: so few chains meet its lobe that their spread is no error. On HST
// with its library materials V of one pose in 24 was 20 standard errors off
// (docs/theory/bounces.md).
TEST(Chains, AFilmAmongPaintsIsLeftToPaths) {
  const Mesh mesh = joined(corner(), sheet(0.2, 0.6, 0.2, 0.6, 0.2, "film"));
  const Scene scene = scene_of(mesh, NormalMode::Flat,
                               {grey(0.8), rough("paper_al", 0.3), interface_of("paper_au", 3000)});
  const ChainSurfaces surfaces(scene);
  const auto kind = [&](std::size_t group) { return surfaces.kind_of(&scene.front[group]); };
  EXPECT_EQ(surfaces.part(kind(0), kind(2)), ChainPart::Nothing);
  EXPECT_EQ(surfaces.part(kind(2), kind(1)), ChainPart::Nothing);
  EXPECT_EQ(surfaces.part(kind(0), kind(1)), ChainPart::Whole);
  EXPECT_TRUE(surfaces.needs_paths());
  const auto square = against_paths(scene, 3, 16);
  for (const double x : square)
    EXPECT_LT(x, most_square);
}

// Chains are drawn in a second or two, levels above the first in minutes: a stop is heard in
// between, and what was half drawn is not taken for whole later.
TEST(Chains, AStopWhileChainsAreDrawnIsHeardAndLeavesNothing) {
  const Scene scene =
      scene_of(three_plates(), NormalMode::Flat, {rough("paper_au", 0.25), grey(0.5)});
  const std::vector<Pose> poses{into_corner(1)};
  const std::vector<double> direct(3);
  const Integrator stopped(scene), fresh(scene);
  std::atomic<bool> cancel{false};
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  std::thread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    cancel = true;
  });
  const auto nothing = stopped.indirect(poses, direct, by_chains(4), 1, &cancel);
  const auto heard = Clock::now() - begin;
  user.join();
  EXPECT_TRUE(nothing.empty());
  const auto again = Clock::now();
  const auto whole = fresh.indirect(poses, direct, by_chains(4), 1);
  EXPECT_LT(heard, (Clock::now() - again) / 2);
  const auto after = stopped.indirect(poses, direct, by_chains(4), 1);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_EQ(after[0].bands[1].stokes.i, whole[0].bands[1].stokes.i);
  EXPECT_EQ(after[0].bands[1].half_width.u, whole[0].bands[1].half_width.u);
}

// The reserve is a million chains, drawn in seconds: heard within them, whenever it comes.
TEST(Chains, AStopWhileTheReserveIsDrawnIsHeardAndLeavesNothing) {
  const Scene scene =
      scene_of(three_plates(), NormalMode::Flat, {rough("paper_au", 0.12), rough("paper_al", 0.1)});
  const std::vector<Pose> poses{into_corner(1)};
  const std::vector<double> direct(3);
  IntegrationOptions options = by_chains(3);
  options.max_points = 1u << 18;
  const Integrator stopped(scene), fresh(scene);
  using Clock = std::chrono::steady_clock;
  const auto again = Clock::now();
  const auto whole = fresh.indirect(poses, direct, options, 1);
  const auto took = Clock::now() - again;
  for (const int part : {1, 5, 9}) { // of ten: rays, thinning, blocks
    std::atomic<bool> cancel{false};
    Clock::time_point asked;
    std::thread user([&] {
      std::this_thread::sleep_for(took * part / 10);
      asked = Clock::now();
      cancel = true;
    });
    const auto nothing = stopped.indirect(poses, direct, options, 1, &cancel);
    const auto ended = Clock::now();
    user.join();
    if (ended < asked)
      continue; // faster than the first time
    EXPECT_TRUE(nothing.empty()) << part;
    EXPECT_LT(ended - asked, took / 4) << part;
  }
  const auto after = stopped.indirect(poses, direct, options, 1);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_EQ(after[0].bands[1].stokes.i, whole[0].bands[1].stokes.i);
  EXPECT_EQ(after[0].bands[1].half_width.u, whole[0].bands[1].half_width.u);
}

TEST(Chains, TheSameBytesForAnyThreadsAndAnySplit) {
  const Scene scene =
      scene_of(three_plates(), NormalMode::Flat, {rough("paper_au", 0.25), grey(0.5)});
  std::vector<Pose> poses;
  for (std::uint64_t i = 0; i < 40; ++i)
    poses.push_back(into_corner(i));
  const auto whole = Integrator(scene).evaluate(poses, by_chains(4, 0.02), 2);
  const Integrator other(scene);
  for (const std::size_t first : {std::size_t{17}, std::size_t{0}}) { // the later part first
    const std::vector<Pose> part(poses.begin() + static_cast<std::ptrdiff_t>(first),
                                 poses.begin() + static_cast<std::ptrdiff_t>(first + 17));
    const auto found = other.evaluate(part, by_chains(4, 0.02), 1);
    for (std::size_t k = 0; k < part.size(); ++k) {
      EXPECT_EQ(found[k].bands[1].stokes.i, whole[first + k].bands[1].stokes.i);
      EXPECT_EQ(found[k].bands[2].stokes.v, whole[first + k].bands[2].stokes.v);
      EXPECT_EQ(found[k].bands[0].half_width.q, whole[first + k].bands[0].half_width.q);
    }
  }
}

} // namespace
} // namespace umov
