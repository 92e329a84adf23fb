// The whole way poses -> "card" -> Stokes, with a driver that runs the kernels of cards on the host
// (paper_cards.h), held against the scalar reference in double.

#include "light/tests/paper_cards.h"

#include <umov/light/light_model.h>

namespace umov::cases {
namespace {

/// Quantiles of what differs from double: I over the larger of I and a tenth of the median light
/// (the floor that accuracies refer to), Q/I where there is as much light.
struct Parity {
  double i_median = 0, i_worst = 0, q_median = 0;
};
Parity parity(const StokesTable &found, const StokesTable &exact) {
  const double floor = 0.1 * quantile(exact.i, 0.5);
  std::vector<double> i, q;
  for (std::size_t k = 0; k < exact.i.size(); ++k) {
    i.push_back(std::abs(found.i[k] - exact.i[k]) / std::max(exact.i[k], floor));
    if (exact.i[k] > floor)
      q.push_back(std::abs(found.q[k] / found.i[k] - exact.q[k] / exact.i[k]));
  }
  return {quantile(i, 0.5), quantile(i, 1), quantile(q, 0.5)};
}

struct Case {
  const char *name;
  Scene scene;
  Visibility visibility;
  bool is_narrow = false; ///< dark but near its glints
};
std::vector<Pose> poses_of(const Case &one, std::size_t count) {
  return one.is_narrow ? through_glint(pi / 2, 0.03, count) : random_poses(count, solar_radius);
}

Material with_lobe(const char *name, const DistributionChoice &lobe, Shadowing shadowing) {
  Material out = interface_of(name, 1);
  out.distribution = lobe;
  out.shadowing = shadowing;
  return out;
}

/// Meshes and materials of the engine's own tests: every lobe, every masking, body light of every
/// kind, roughness by band, smooth normals, a surface without a kernel.
std::vector<Case> all_cases() {
  std::vector<Case> out;
  const Mesh cube = make_chamfered_cube(1, 0.1), ball = make_sphere(1, 300);
  const DistributionChoice lobes[] = {blinn_phong(5),
                                      blinn_phong(200),
                                      blinn_phong(1000),
                                      {"beckmann", {{"alpha", 0.2}}, {}, {}, {}},
                                      {"beckmann", {{"alpha", 0.03}}, {}, {}, {}},
                                      {"ggx", {{"alpha", 0.15}}, {}, {}, {}},
                                      {"ggx", {{"alpha", 0.03}}, {}, {}, {}}};
  for (const auto &lobe : lobes)
    for (const Shadowing shadowing : {Shadowing::Ashikhmin, Shadowing::Smith, Shadowing::Separable})
      out.push_back({"lobe",
                     scene_of(cube, NormalMode::Flat, {with_lobe("paper_al", lobe, shadowing)}),
                     Visibility::None});
  for (const Interreflection kind :
       {Interreflection::None, Interreflection::Unpolarized, Interreflection::SingleBounceQ}) {
    Material material = builtin_material("paper_asi").value();
    material.interreflection = kind;
    out.push_back({"diffuse", scene_of(ball, NormalMode::Flat, {material}), Visibility::None});
  }
  Material silicon = builtin_material("paper_asi").value();
  silicon.body->is_polarized = true;
  out.push_back({"body", scene_of(cube, NormalMode::Flat, {silicon}), Visibility::None});
  Material by_band = interface_of("paper_al", 200);
  by_band.apparent_roughness = ApparentRoughness{0.8, 550, {}};
  out.push_back({"by band", scene_of(ball, NormalMode::Flat, {by_band}), Visibility::None});
  Material brushed = interface_of("paper_al", 1);
  brushed.distribution = {"ashikhmin_shirley", {{"nu", 10}, {"nv", 300}}, {}, {}, {}};
  brushed.direction = Vec3<Body>{1, 0, 0};
  out.push_back({"no kernel", scene_of(ball, NormalMode::Flat, {brushed}), Visibility::None});
  Material film = interface_of("paper_al", 200); // interferes too fast to be interpolated: its sums
  film.layers = {{constant_index({1.5, 0}), 50'000, true}}; // come out to be coloured
  out.push_back({"thick film", scene_of(cube, NormalMode::Flat, {film}), Visibility::None});
  out.push_back({"smooth", scene_of(make_cylinder(1, 2, 24), NormalMode::Smooth, four_materials()),
                 Visibility::None});
  // Narrower than a curved part's elements: the entry of cards that is compiled apart
  for (const auto &lobe : {DistributionChoice{"ggx", {{"alpha", 0.01}}, {}, {}, {}},
                           DistributionChoice{"beckmann", {{"alpha", 0.01}}, {}, {}, {}}})
    out.push_back({"narrow on curved",
                   scene_of(make_cylinder(1, 2, 24), NormalMode::Smooth,
                            {with_lobe("paper_al", lobe, Shadowing::Smith)}),
                   Visibility::None, true});
  out.push_back({"box with wings",
                 scene_of(make_box_wing({3000, 0}), NormalMode::Flat, four_materials()),
                 Visibility::Masks});
  return out;
}

TEST(Cards, AgreeWithScalarDouble) {
  for (const Case &one : all_cases()) {
    const auto poses = poses_of(one, 200);
    const Parity p = parity(evaluated(on_card(one.scene, one.visibility), poses),
                            evaluated(engine_of(one.scene, one.visibility, true), poses));
    EXPECT_LT(p.i_median, 2e-4) << one.name;
    EXPECT_LT(p.i_worst, 1e-3) << one.name;
    EXPECT_LT(p.q_median, 2e-5) << one.name;
  }
}

TEST(Cards, HalfWidthsAreThoseOfTheProcessor) {
  const Scene scene = scene_of(make_box_wing({3000, 0}), NormalMode::Flat, four_materials());
  const auto poses = random_poses(200, solar_radius);
  const StokesTable found = evaluated(on_card(scene, Visibility::Masks), poses),
                    exact = evaluated(engine_of(scene, Visibility::Masks, true), poses);
  std::size_t uncertain = 0;
  for (std::size_t k = 0; k < exact.i_err.size(); ++k) {
    uncertain += exact.i_err[k] > 1e-4 * exact.i[k] ? 1u : 0u;
    EXPECT_NEAR(found.i_err[k], exact.i_err[k], 2e-3 * exact.i_err[k] + 1e-4 * exact.i[k]) << k;
  }
  EXPECT_GT(uncertain, 100u); // masks do err
}

TEST(Cards, WholeSatellitesAgreeWithJoinedFacetsToo) {
  for (const Mesh &mesh : {make_hst(), make_agena()})
    for (const double cluster_rad : {0.0, 3 * pi / 180}) {
      const Scene scene = scene_of(mesh, NormalMode::Smooth, four_materials());
      EngineOptions options;
      options.masks = {10'000, 16, 16, 0};
      options.cluster_rad = cluster_rad;
      Engine card(scene, options);
      ASSERT_TRUE(card.use_cards(open_cards(with_fakes()).value()));
      options.is_double = true;
      const auto poses = random_poses(100, solar_radius);
      const StokesTable found = evaluated(card, poses),
                        exact = evaluated(Engine(scene, options), poses);
      const Parity p = parity(found, exact);
      EXPECT_LT(p.i_median, 2e-4) << cluster_rad;
      EXPECT_LT(p.i_worst, 1e-3) << cluster_rad;
      EXPECT_LT(p.q_median, 2e-5) << cluster_rad;
      for (std::size_t k = 0; k < exact.i_err.size(); ++k)
        EXPECT_NEAR(found.i_err[k], exact.i_err[k], 2e-3 * exact.i_err[k] + 1e-4 * exact.i[k]) << k;
    }
}

TEST(Cards, ColoursOfACardAreThoseOfItsSums) {
  // With the share of glints asked for, sums come out and the processor colours them.
  for (const Case &one : all_cases()) {
    const auto poses = poses_of(one, 40);
    const Engine engine = on_card(one.scene, one.visibility);
    LightTask task;
    task.has_glints = true;
    StokesTable sums;
    ASSERT_TRUE(engine.evaluate(poses, sums, task));
    const StokesTable light = evaluated(engine, poses);
    EXPECT_EQ(light.is_dark, sums.is_dark);
    EXPECT_EQ(light.method, sums.method);
    constexpr double least = 1e-37; // where single precision has fewer digits
    for (std::size_t k = 0; k < light.i.size(); ++k) {
      // A dozen roundings to 2^-24.
      const double near = 3e-6 * sums.i[k] + least;
      const auto expect = [&](double of_card, double wanted, double tolerance) {
        EXPECT_NEAR(of_card, wanted, tolerance) << one.name << " " << k;
      };
      expect(light.i[k], sums.i[k], near);
      expect(light.q[k], sums.q[k], near);
      expect(light.u[k], sums.u[k], near);
      expect(light.i_err[k], sums.i_err[k], 1e-4 * sums.i_err[k] + least);
      expect(light.q_err[k], sums.q_err[k], 1e-4 * sums.q_err[k] + least);
      expect(light.u_err[k], sums.u_err[k], 1e-4 * sums.u_err[k] + least);
      expect(light.v_err[k], sums.v_err[k], 1e-4 * sums.v_err[k] + least);
    }
  }
}

TEST(Cards, TheBytesDoNotDependOnTheSplit) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  const auto poses = random_poses(9000, solar_radius);
  const Engine engine = on_card(scene, Visibility::Masks);
  const StokesTable whole = evaluated(engine, poses);
  {
    const Setting two("UMOV_FAKE_CARDS", "3");
    const StokesTable shared = evaluated(on_card(scene, Visibility::Masks), poses, 1);
    EXPECT_EQ(shared.i, whole.i);
    EXPECT_EQ(shared.q_err, whole.q_err);
  }
  for (const std::size_t size : {std::size_t{1}, std::size_t{77}, std::size_t{4097}}) {
    const std::size_t first = 40;
    const auto span = std::span(poses).subspan(first, size);
    const std::vector<Pose> some(span.begin(), span.end());
    const StokesTable part = evaluated(engine, some);
    for (std::size_t k = 0; k < size * part.bands; ++k) {
      EXPECT_EQ(part.i[k], whole.i[first * whole.bands + k]);
      EXPECT_EQ(part.q[k], whole.q[first * whole.bands + k]);
      EXPECT_EQ(part.i_err[k], whole.i_err[first * whole.bands + k]);
    }
  }
}

TEST(Cards, AbundancesAreThoseOfTheProcessor) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  const auto poses = random_poses(300, solar_radius);
  AbundanceTable found, wanted;
  ASSERT_TRUE(on_card(scene, Visibility::Masks).abundances(poses, found));
  ASSERT_TRUE(engine_of(scene, Visibility::Masks, true).abundances(poses, wanted));
  ASSERT_EQ(found.sum.size(), wanted.sum.size());
  const double scale = *std::max_element(wanted.sum.begin(), wanted.sum.end());
  std::size_t uncertain = 0;
  for (std::size_t k = 0; k < wanted.sum.size(); ++k) {
    EXPECT_NEAR(found.sum[k], wanted.sum[k], 2e-4 * wanted.sum[k] + 1e-6 * scale) << k;
    // The variance of looked-up shares is a difference of squares: 2^-24 of a square is 2.4e-4 of
    // its root, and the half-width 1.96 of that.
    EXPECT_NEAR(found.half_width[k], wanted.half_width[k],
                2e-3 * wanted.half_width[k] + 5e-4 * wanted.sum[k] + 2e-6 * scale)
        << k;
    uncertain += wanted.half_width[k] > 1e-3 * wanted.sum[k] ? 1U : 0U;
  }
  EXPECT_GT(uncertain, 100U);
  EXPECT_EQ(found.is_dark, wanted.is_dark);
}

TEST(Cards, RaysMendWhatTheirMasksLeave) {
  // What is mended is traced by the processor, from the pose and the sums of the card.
  const Scene scene = scene_of(box_wing(), NormalMode::Flat, four_materials());
  EngineOptions options;
  options.masks = {10'000, 16, 16, 0.002};
  options.doubts_all = true;
  Engine engine(scene, options);
  const auto poses = random_poses(60);
  const StokesTable wanted = evaluated(engine, poses);
  ASSERT_TRUE(engine.use_cards(open_cards(with_fakes()).value()));
  const StokesTable found = evaluated(engine, poses);
  std::size_t mended = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    mended += found.method[k] == PoseMethod::Mended ? 1u : 0u;
    const BandResult a = found.at(k, 1), b = wanted.at(k, 1);
    EXPECT_NEAR(a.stokes.i, b.stokes.i, a.half_width.i + b.half_width.i) << k;
  }
  EXPECT_GT(mended, 10u);
}

TEST(Cards, LazyMasksArePutAgainWhenTheyGrow) {
  const Scene scene = scene_of(make_box_wing({800, 0}), NormalMode::Flat, four_materials());
  EngineOptions options;
  options.masks = {20'000, 24, 24, 0};
  Engine all(scene, options);
  options.is_lazy = true;
  Engine lazy(scene, options);
  const auto cards = open_cards(with_fakes()).value();
  ASSERT_TRUE(all.use_cards(cards));
  ASSERT_TRUE(lazy.use_cards(cards));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto poses = random_poses(4 * (k + 1));
    EXPECT_EQ(evaluated(lazy, poses).i, evaluated(all, poses).i) << k;
  }
}

TEST(Cards, BandsWithACurveAreLitInBatchesAsLongAsOthers) {
  // Nobody else's number: 9,000 poses in two shares, three kernels each, with a curve or without.
  const auto poses = random_poses(9000);
  std::size_t count[2];
  for (const bool has_curve : {false, true}) {
    std::vector<Band> bands{{"nm:600", Wavelength::nm(600)}};
    if (has_curve)
      bands.push_back(*band_of(gaussian_passband("green", 540, 60)));
    const auto materials = four_materials();
    const Mesh mesh = make_chamfered_cube(1, 0.1);
    Diagnostics diagnostics;
    const std::vector<Material> of(mesh.groups.size(), materials.front());
    const auto scene = make_scene(mesh, NormalMode::Flat, bands, of, of, diagnostics);
    ASSERT_TRUE(scene) << scene.error().text();
    LightOptions options;
    options.method = LightMethod::Masks;
    options.device = with_fakes();
    const auto model = make_light(*scene, {}, options);
    ASSERT_TRUE(model) << model.error().text();
    const std::size_t before = launches();
    StokesTable out;
    ASSERT_TRUE((*model)->evaluate(poses, out));
    count[has_curve ? 1 : 0] = launches() - before;
  }
  EXPECT_EQ(count[0], 6u);
  EXPECT_EQ(count[1], count[0]);
}

TEST(Cards, NoLaunchTakesSecondsAndNoByteDependsOnIt) {
  // A card that drives a screen too ends what runs long. 10,000 facets and 4,500 poses a batch: one
  // launch of sums on a large card, three on one with a single multiprocessor (2^24 each at most).
  const Scene scene =
      scene_of(make_sphere(1, 10'000), NormalMode::Flat, {builtin_material("paper_asi").value()});
  const auto poses = random_poses(9000, solar_radius);
  const auto lit = [&](std::size_t &count) {
    const Engine engine = on_card(scene, Visibility::None);
    const std::size_t before = launches();
    StokesTable out = evaluated(engine, poses);
    count = launches() - before;
    return out;
  };
  std::size_t once = 0, often = 0;
  const StokesTable whole = lit(once);
  const Setting small("UMOV_FAKE_PROCESSORS", "1"), strict("UMOV_FAKE_WATCHDOG", "16777216");
  const StokesTable parts = lit(often);
  EXPECT_EQ(once, 6U); // two batches, three kernels each
  EXPECT_EQ(often, 10U);
  EXPECT_EQ(parts.i, whole.i);
  EXPECT_EQ(parts.q, whole.q);
  EXPECT_EQ(parts.i_err, whole.i_err);
  EXPECT_EQ(parts.is_dark, whole.is_dark);
}

TEST(Cards, FacetsInTheDarkOfTheirLobesAreFoundInEveryPart) {
  // Narrow lobes alone: what is lit and seen but beyond their reach is dark, not hidden, whichever
  // launch its facets are in.
  const Scene scene = scene_of(make_sphere(1, 60'000), NormalMode::Flat,
                               {with_lobe("paper_al", blinn_phong(2e4), Shadowing::Separable)});
  const auto poses = random_poses(300, solar_radius);
  const auto dark = [&] { return evaluated(on_card(scene, Visibility::None), poses).is_dark; };
  const auto whole = dark();
  const Setting small("UMOV_FAKE_PROCESSORS", "1"), strict("UMOV_FAKE_WATCHDOG", "16777216");
  EXPECT_EQ(dark(), whole);
}

} // namespace
} // namespace umov::cases
