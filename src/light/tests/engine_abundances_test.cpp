// Sums that serve other materials and bands.

#include "light/tests/engine_cases.h"

namespace umov::cases {
namespace {

AbundanceTable sums_of(const Engine &engine, const std::vector<Pose> &poses, unsigned threads = 2) {
  AbundanceTable out;
  const auto done = engine.abundances(poses, out, threads);
  EXPECT_TRUE(done) << done.error().text();
  return out;
}

StokesTable applied(const Engine &engine, const Scene &materials, const AbundanceTable &sums) {
  const auto tables = engine.tables_for(materials);
  EXPECT_TRUE(tables) << tables.error().text();
  StokesTable out;
  if (tables)
    tables->apply(sums, out, 2);
  return out;
}

/// Largest difference of I and of Q, in parts of the larger of I and a thousandth of the brightest.
double apart(const StokesTable &a, const StokesTable &b) {
  EXPECT_EQ(a.i.size(), b.i.size());
  EXPECT_EQ(a.is_dark, b.is_dark);
  const double brightest = *std::max_element(b.i.begin(), b.i.end());
  double worst = 0;
  for (std::size_t k = 0; k < a.i.size(); ++k) {
    const double scale = std::max(b.i[k], 1e-3 * brightest);
    worst = std::max({worst, std::abs(a.i[k] - b.i[k]) / scale, std::abs(a.q[k] - b.q[k]) / scale});
  }
  return worst;
}

std::vector<Material> same_shapes(const char *first, const char *second, bool has_body) {
  std::vector<Material> out;
  for (const char *name : {first, second}) {
    out.push_back(builtin_material(name).value());
    out.back().distribution = blinn_phong(out.size() == 1 ? 200 : 50);
    if (!has_body)
      out.back().body.reset();
  }
  return out;
}

TEST(EngineAbundances, GiveWhatTheEngineGives) {
  // The same sums by the same coefficients: only the order of a few products differs.
  const Scene scene = scene_of(make_box_wing({2000, 0}), NormalMode::Flat, four_materials());
  const Engine engine = engine_of(scene, Visibility::Masks);
  const auto poses = random_poses(300, solar_radius);
  const AbundanceTable sums = sums_of(engine, poses);
  const StokesTable direct = evaluated(engine, poses), indirect = applied(engine, scene, sums);
  EXPECT_LT(apart(indirect, direct), 1e-13);
  for (std::size_t k = 0; k < direct.i.size(); ++k)
    EXPECT_NEAR(indirect.i_err[k], direct.i_err[k], 1e-12 * direct.i_err[k]);
  // Equal materials are summed together: four, not one per mesh group and side.
  std::size_t specular = 0;
  for (const AbundanceColumn &column : sums.columns)
    specular += column.kind == AbundanceColumn::Kind::Specular ? 1u : 0u;
  EXPECT_EQ(specular, 3u); // the index of the white paint is 1: no lobe
  EXPECT_EQ(sums_of(engine, poses, 1).sum, sums_of(engine, poses, 8).sum);
}

TEST(EngineAbundances, HoldPaintsWhoseLightIsPolarized) {
  std::vector<Material> materials = four_materials();
  materials[1].body->is_polarized = true;
  const Scene scene = scene_of(make_box_wing({2000, 0}), NormalMode::Flat, materials);
  const Engine engine = engine_of(scene, Visibility::Masks);
  const auto poses = random_poses(300, solar_radius);
  const StokesTable direct = evaluated(engine, poses),
                    indirect = applied(engine, scene, sums_of(engine, poses));
  EXPECT_LT(apart(indirect, direct), 1e-13);
  for (std::size_t k = 0; k < direct.u.size(); ++k)
    EXPECT_NEAR(indirect.u[k], direct.u[k], 1e-13 * direct.i[k]);
  EXPECT_GT(*std::max_element(direct.u.begin(), direct.u.end()), 0);
}

TEST(EngineAbundances, RaysForUncertainPosesAreInTheSums) {
  const Scene scene = scene_of(make_box_wing({2000, 0}), NormalMode::Flat, four_materials());
  EngineOptions options;
  options.masks = {20'000, 24, 24, 0.02};
  const Engine engine(scene, options);
  const auto poses = random_poses(200, solar_radius);
  EXPECT_LT(apart(applied(engine, scene, sums_of(engine, poses)), evaluated(engine, poses)), 1e-13);
}

TEST(EngineAbundances, ServeOtherIndicesAndBands) {
  // Without body light nothing is fitted: another engine on the other materials sums the same.
  const Mesh mesh = make_box_wing({2000, 0});
  const Scene metals = scene_of(mesh, NormalMode::Flat, same_shapes("paper_au", "paper_al", false));
  std::vector<Material> per_group;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    per_group.push_back(same_shapes("paper_bk7", "paper_asi", false)[g % 2]);
  Diagnostics diagnostics;
  const Scene glass = make_scene(mesh, NormalMode::Flat, {{"nm:600", Wavelength::nm(600)}},
                                 per_group, per_group, diagnostics)
                          .value();
  const Engine engine = engine_of(metals, Visibility::Masks);
  const auto poses = random_poses(200, solar_radius);
  const StokesTable wanted = evaluated(engine_of(glass, Visibility::Masks), poses);
  EXPECT_LT(apart(applied(engine, glass, sums_of(engine, poses)), wanted), 1e-13);
}

TEST(EngineAbundances, BodyLightOfOthersIsWithinItsStatedError) {
  const Mesh mesh = make_box_wing({2000, 0});
  auto materials = same_shapes("paper_asi", "paper_asi", true);
  const Scene known = scene_of(mesh, NormalMode::Flat, materials);
  for (Material &material : materials)
    material.index = builtin_index("paper_bk7").value();
  const Scene other = scene_of(mesh, NormalMode::Flat, materials);
  const auto poses = random_poses(200, solar_radius);
  const StokesTable wanted = evaluated(engine_of(other, Visibility::None), poses);
  const Engine unaware = engine_of(known, Visibility::None);
  const auto tables = unaware.tables_for(other);
  ASSERT_TRUE(tables) << tables.error().text();
  EXPECT_LT(apart(applied(unaware, other, sums_of(unaware, poses)), wanted),
            2 * tables->diffuse_error() + 5e-4);
  // Named beforehand, it is served as well as the engine's own.
  EngineOptions options;
  options.visibility = Visibility::None;
  options.hypotheses = {other};
  const Engine aware(known, options);
  EXPECT_LT(aware.tables_for(other)->diffuse_error(), 0.1 * tables->diffuse_error());
  EXPECT_LT(apart(applied(aware, other, sums_of(aware, poses)), wanted), 5e-4);
}

TEST(EngineAbundances, RefuseWhatTheyWereNotMadeFor) {
  const Mesh mesh = make_box_wing({2000, 0});
  const auto refusal = [&](const std::vector<Material> &materials) {
    const Engine engine =
        engine_of(scene_of(mesh, NormalMode::Flat, same_shapes("paper_au", "paper_al", false)),
                  Visibility::None);
    const auto tables = engine.tables_for(scene_of(mesh, NormalMode::Flat, materials));
    return tables ? std::string() : tables.error().message;
  };
  auto rougher = same_shapes("paper_au", "paper_al", false);
  rougher[0].distribution = blinn_phong(20);
  EXPECT_NE(refusal(rougher).find("roughness"), std::string::npos);
  EXPECT_NE(refusal(same_shapes("paper_asi", "paper_asi", true)).find("body light"),
            std::string::npos);
  auto three = same_shapes("paper_au", "paper_al", false);
  three.push_back(interface_of("paper_asi", 200));
  EXPECT_NE(refusal(three).find("one material in these sums"), std::string::npos);
  Material brushed = interface_of("paper_al", 1);
  brushed.distribution = {"ashikhmin_shirley", {{"nu", 10}, {"nv", 300}}, {}, {}, {}};
  brushed.direction = Vec3<Body>{1, 0, 0};
  AbundanceTable unused;
  const auto none = engine_of(scene_of(mesh, NormalMode::Flat, {brushed}), Visibility::None)
                        .abundances(random_poses(1), unused);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("facet by facet"), std::string::npos);
}

TEST(EngineAbundances, IntensityAloneIsTheSameIntensity) {
  const Scene scene = scene_of(make_box_wing({2000, 0}), NormalMode::Flat, four_materials());
  EngineOptions options;
  options.visibility = Visibility::None;
  const auto poses = random_poses(50);
  const StokesTable whole = evaluated(Engine(scene, options), poses);
  options.is_intensity_only = true;
  const StokesTable alone = evaluated(Engine(scene, options), poses);
  EXPECT_EQ(whole.i, alone.i);
  EXPECT_EQ(std::count(alone.q.begin(), alone.q.end(), 0.0),
            static_cast<std::ptrdiff_t>(alone.q.size()));
}

} // namespace
} // namespace umov::cases
