// The one way from poses to Stokes: methods against each other, rows that do not know their
// neighbours, masks on demand and on disk.

#include "light/tests/integrator_cases.h"

#include <filesystem>
#include <umov/core/files.h>
#include <umov/light/engine.h>
#include <umov/light/light_model.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

using namespace cases;

std::vector<Pose> many_poses(std::size_t count) {
  std::vector<Pose> out;
  for (std::size_t k = 0; k < count; ++k) {
    out.push_back(random_pose(3, k, Angle::degrees(40 + 80.0 * static_cast<double>(k % 10) / 10)));
    out.back().sun_radius_rad = sun_radius_at_1au_rad;
  }
  return out;
}

StokesTable lit(const LightModel &light, const std::vector<Pose> &poses, unsigned threads = 2) {
  StokesTable out;
  LightTask task{true, true, threads, nullptr};
  EXPECT_TRUE(light.evaluate(poses, out, task));
  return out;
}

std::unique_ptr<LightModel> model(LightOptions options) {
  auto made = make_light(box_wing_scene(), {}, options);
  EXPECT_TRUE(made) << made.error().text();
  return std::move(*made);
}

TEST(LightModel, RaysAreTheReferenceToTheBit) {
  const Scene scene = box_wing_scene();
  const auto poses = many_poses(6);
  const auto table = lit(*model({.method = LightMethod::Rays}), poses);
  const auto reference = Integrator(scene).evaluate(poses, {}, 1);
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_EQ(table.i[k * 3 + b], reference[k].bands[b].stokes.i);
      EXPECT_EQ(table.q_err[k * 3 + b], reference[k].bands[b].half_width.q);
    }
}

// The half-widths are 95 % ones: of 120 rows 114 are expected inside, fewer than 105 with a chance
// of 1e-4 if rows were independent.
TEST(LightModel, AutoMeetsTheAccuracyAndItsHalfWidthsCoverRays) {
  const auto poses = many_poses(120);
  const auto fast = lit(*model({}), poses);
  const auto dense = lit(*model({.method = LightMethod::Rays, .accuracy = 5e-4}), poses);
  const std::vector<double> floor = model({})->facts().floor_i;
  ASSERT_EQ(floor.size(), 3U);
  std::size_t covered = 0, accurate = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::size_t at = k * 3 + 1;
    covered += std::abs(fast.i[at] - dense.i[at]) <= fast.i_err[at] + dense.i_err[at] ? 1u : 0u;
    accurate += fast.i_err[at] <= 0.005 * 1.002 * std::max(fast.i[at], floor[1]) ? 1u : 0u;
  }
  EXPECT_GE(covered, 105U);
  EXPECT_GE(accurate, 118U);
}

// As above: 105 of 120 rows. What masks of 70 cells tell to 5 % needs no rays in nine of ten poses.
TEST(LightModel, ManyPosesMeetTheirAccuracyWithFewRaysAndHalfWidthsCoverThem) {
  const auto poses = many_poses(120);
  const auto many = model(for_many_poses({}));
  const auto fast = lit(*many, poses);
  const auto dense = lit(*model({.method = LightMethod::Rays, .accuracy = 5e-4}), poses);
  const std::vector<double> floor = many->facts().floor_i, usual = model({})->facts().floor_i;
  ASSERT_EQ(floor.size(), 3U);
  EXPECT_NEAR(floor[1], 0.2 * usual[1], 1e-12 * usual[1]);
  std::size_t covered = 0, accurate = 0, looked_up = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::size_t at = k * 3 + 1;
    covered += std::abs(fast.i[at] - dense.i[at]) <= fast.i_err[at] + dense.i_err[at] ? 1u : 0u;
    accurate += fast.i_err[at] <= 0.05 * 1.002 * std::max(fast.i[at], floor[1]) ? 1u : 0u;
    looked_up += fast.method[k] == PoseMethod::Masks ? 1u : 0u;
  }
  EXPECT_GE(covered, 105U);
  EXPECT_EQ(accurate, poses.size());
  EXPECT_GE(looked_up, 100U);
}

// Pose 10,806 of a sweep over all phases: these masks see a little of Agena of which rays find
// nothing.
TEST(LightModel, LightThatRaysTakeAwayLeavesNoLessThanNone) {
  std::vector<Material> materials;
  for (const auto &[name, exponent] : {std::pair{"paper_au", 200.0},
                                       {"paper_asi", 1000.0},
                                       {"paper_spectralon", 20.0},
                                       {"paper_al", 50.0}}) {
    materials.push_back(builtin_material(name).value());
    materials.back().distribution = blinn_phong(exponent);
  }
  const Scene scene = scene_of(make_agena(), NormalMode::Flat, materials);
  EngineOptions options; // as tables of many poses have it, with the masks in which this was seen
  options.masks = {60'000, 64, 64, 0.038};
  options.is_for_many_poses = options.is_lazy = true;
  options.q_part = 1;
  for (const double light : typical_light(scene))
    options.floor_i.push_back(0.02 * light);
  const std::size_t number = 10'806;
  const double share = std::fmod(0.5 + 0.6180339887498949 * static_cast<double>(number), 1.0);
  Pose pose = random_pose(11, number, Angle::degrees(180 * share));
  pose.sun_radius_rad = sun_radius_at_1au_rad;
  StokesTable table;
  Engine(scene, options).evaluate({&pose, 1}, table);
  EXPECT_EQ(table.method[0], PoseMethod::Mended);
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_GE(table.i[b], 0);
    EXPECT_LE(std::hypot(table.q[b], table.u[b]), table.i[b]);
    EXPECT_GT(table.i_err[b], 0);
  }
}

TEST(LightModel, OnlyAutoIsAskedOtherwiseForManyPoses) {
  for (const LightMethod method : {LightMethod::Rays, LightMethod::Masks}) {
    const LightOptions many = for_many_poses({.method = method});
    EXPECT_EQ(many.accuracy, LightOptions{}.accuracy);
    EXPECT_FALSE(many.is_for_many_poses || many.accuracy_floor);
  }
  EXPECT_EQ(for_many_poses({.bounces = 2}).accuracy, LightOptions{}.accuracy);
  EXPECT_EQ(for_many_poses({.accuracy_floor = 0.3}).accuracy_floor, 0.3);
}

TEST(LightModel, ARowDoesNotKnowItsNeighbours) {
  const auto poses = many_poses(40);
  for (const LightMethod method : {LightMethod::Rays, LightMethod::Masks, LightMethod::Auto}) {
    LightOptions options;
    options.method = method;
    options.accuracy = 0.02;
    const auto all = lit(*model(options), poses, 3);
    const auto light = model(options);
    for (const std::size_t k : {std::size_t{31}, std::size_t{0}, std::size_t{17}}) {
      const auto one = lit(*light, {poses[k]}, 1);
      for (std::size_t b = 0; b < 3; ++b) {
        EXPECT_EQ(one.i[b], all.i[k * 3 + b]) << name_of(method) << " " << k;
        EXPECT_EQ(one.q_err[b], all.q_err[k * 3 + b]) << name_of(method) << " " << k;
      }
      EXPECT_EQ(one.method[0], all.method[k]);
    }
  }
}

TEST(LightModel, MaterialsAddUpToDirectLight) {
  const auto poses = many_poses(20);
  for (const LightMethod method : {LightMethod::Rays, LightMethod::Masks, LightMethod::Auto}) {
    const auto light = model({.method = method});
    const std::size_t materials = light->materials().size();
    const auto table = lit(*light, poses);
    for (std::size_t k = 0; k < poses.size(); ++k)
      for (std::size_t b = 0; b < 3; ++b) {
        double sum = 0;
        for (std::size_t m = 0; m < materials; ++m)
          sum += table.material_i[(k * materials + m) * 3 + b];
        EXPECT_NEAR(sum, table.i[k * 3 + b], 1e-9 * table.i[k * 3 + b]) << name_of(method);
      }
  }
}

// Flats within their lobe's half width of the half vector: the same poses by both ways.
TEST(LightModel, MasksTellGlintsAsRaysDo) {
  std::vector<Pose> poses;
  for (int k = 0; k < 30; ++k) { // the half vector passes over the panels' normal
    const double a = Angle::degrees(-8 + 0.5 * k).radians(), half = Angle::degrees(30).radians();
    poses.push_back({{std::sin(a + half), 0, std::cos(a + half)},
                     {std::sin(a - half), 0, std::cos(a - half)},
                     sun_radius_at_1au_rad});
  }
  const auto rays = lit(*model({.method = LightMethod::Rays}), poses);
  const auto masks = lit(*model({.method = LightMethod::Masks}), poses);
  std::size_t glints = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_NEAR(rays.glint_share[k], masks.glint_share[k], 0.03) << k; // errors of I in both
    glints += rays.glint_share[k] > 0.1 ? 1u : 0u;
  }
  EXPECT_GT(glints, 3U);
}

TEST(LightModel, CacheGivesTheSameBytesAndSurvivesDamage) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "umov_mask_cache";
  std::filesystem::remove_all(folder);
  const auto poses = many_poses(10);
  LightOptions options;
  options.mask_cache = folder;
  const auto fresh = model(options);
  const auto first = lit(*fresh, poses);
  ASSERT_TRUE(fresh->keep_masks());
  ASSERT_FALSE(std::filesystem::is_empty(folder));
  EXPECT_EQ(lit(*model(options), poses).i, first.i);
  for (const auto &entry : std::filesystem::directory_iterator(folder)) {
    std::string bytes = *read_file(entry.path());
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
    ASSERT_TRUE(write_file_atomically(entry.path(), bytes));
  }
  const auto mended = model(options);
  EXPECT_EQ(lit(*mended, poses).i, first.i);
  ASSERT_TRUE(mended->keep_masks());
  EXPECT_EQ(lit(*model(options), poses).i_err, first.i_err);
}

TEST(LightModel, MasksOfSeveralJobsAreJoinedInTheCache) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "umov_joined_masks";
  std::filesystem::remove_all(folder);
  const auto all = many_poses(20);
  const std::vector<Pose> some(all.begin(), all.begin() + 10), others(all.begin() + 10, all.end());
  LightOptions options{.method = LightMethod::Masks};
  options.mask_cache = folder;
  const auto one = model(options), another = model(options); // at the same time
  (void)lit(*one, some);
  (void)lit(*another, others);
  ASSERT_TRUE(one->keep_masks());
  ASSERT_TRUE(another->keep_masks());
  const auto next = model(options);
  const std::size_t known = next->mask_bytes();
  const auto table = lit(*next, all);
  EXPECT_EQ(next->mask_bytes(), known); // nothing was traced anew
  const auto fresh = lit(*model({.method = LightMethod::Masks}), all);
  EXPECT_EQ(table.i, fresh.i);
  EXPECT_EQ(table.q_err, fresh.q_err);
}

// Masks that see nothing are no proof: what may have been missed stands beside I = 0, and the row
// does not say that nothing hides anything.
TEST(LightModel, DarknessSaysHowItIsKnown) {
  std::vector<Pose> poses;
  for (std::uint64_t k = 0; k < 200; ++k)
    poses.push_back(random_pose(9, k, Angle::degrees(165)));
  for (const LightMethod method : {LightMethod::Masks, LightMethod::Auto}) {
    const auto table = lit(*model({.method = method}), poses);
    std::size_t dark = 0, doubted = 0;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      EXPECT_NE(table.method[k], PoseMethod::Exact);
      dark += table.is_dark[k] != 0 ? 1u : 0u;
      doubted += table.is_dark[k] != 0 && table.i_err[k * 3] > 0 ? 1u : 0u;
    }
    ASSERT_GT(dark, 0U);
    if (method == LightMethod::Auto) {
      EXPECT_GT(doubted, 0U);
    }
  }
}

Joint wings() {
  Joint out;
  out.name = "wings";
  out.groups = {"panels"};
  return out;
}

TEST(LightModel, OptionsOutsideTheirRangeAreRefused) {
  const auto refused = [](LightOptions options, std::vector<Joint> joints = {}) {
    const auto made = make_light(box_wing_scene(), std::move(joints), options);
    EXPECT_FALSE(made);
    return made ? "" : made.error().message;
  };
  EXPECT_EQ(refused({.accuracy = 0}), "accuracy is 0; a number above 0, up to 1, was expected");
  EXPECT_EQ(refused({.accuracy_floor = -1}), "accuracy_floor is -1; 0 or more was expected");
  EXPECT_EQ(refused({.bounces = 65}), "bounces is 65; 1 to 64 was expected");
  LightOptions kept;
  kept.mask_file = "some.masks";
  EXPECT_NE(refused(kept, {wings()}).find("has its own"), std::string::npos);
}

// A part that turns emits as it stands then, not as the mesh has it.
TEST(LightModel, HeatFollowsThePartsThatTurn) {
  const Scene scene = box_wing_scene();
  const std::vector<Joint> joints{wings()};
  const std::vector<double> kelvin(scene.mesh.groups.size(), 3000);
  LightOptions options;
  options.accuracy = 0.002;
  const auto turning = make_thermal_light(scene, joints, kelvin, options);
  ASSERT_TRUE(turning);
  const Pose pose{{0, 0, 1}, {0, 0, 1}};
  for (const double angle : {0.0, 1.2}) {
    Scene turned = scene;
    turned.mesh = posed(scene.mesh, joints, {angle});
    const auto still = make_thermal_light(turned, {}, kelvin, options);
    ASSERT_TRUE(still);
    StokesTable a, b;
    LightTask task;
    task.has_glints = task.has_materials = true;
    ASSERT_TRUE((*turning)->evaluate({&pose, 1}, {&angle, 1}, a, task));
    ASSERT_TRUE((*still)->evaluate({&pose, 1}, b, task));
    EXPECT_EQ(a.i, b.i);
    EXPECT_EQ(a.glint_share, std::vector<double>{0});
  }
}

// Masks of many directions take minutes: a job that is stopped does not wait for them, and what was
// traced serves the next one.
TEST(LightModel, TracingMasksCanBeStopped) {
  const auto light = model({.method = LightMethod::Masks});
  const auto poses = many_poses(100);
  std::atomic<bool> cancel = true;
  LightTask task;
  task.cancel = &cancel;
  StokesTable out;
  const std::size_t before = light->mask_bytes();
  EXPECT_FALSE(light->evaluate(poses, out, task));
  EXPECT_EQ(light->mask_bytes(), before);
  cancel = false;
  ASSERT_TRUE(light->evaluate(poses, out, task));
  EXPECT_EQ(out.i, lit(*model({.method = LightMethod::Masks}), poses).i);
}

TEST(LightModel, FewPosesTraceFewDirections) {
  const auto light = model({.method = LightMethod::Masks});
  const std::size_t before = light->mask_bytes();
  (void)lit(*light, many_poses(2));
  const std::size_t few = light->mask_bytes() - before;
  (void)lit(*light, many_poses(400));
  EXPECT_GT(few, 0U);
  EXPECT_GT(light->mask_bytes() - before, 20 * few);
}

TEST(LightModel, TypicalLightOfASphereIsKnown) { // Lambert: (2/3) [sin a + (pi - a) cos a] / pi
  const Scene ball = scene_of(make_sphere(1, 20'000), NormalMode::Smooth, {white_lambert()});
  std::vector<double> light;
  for (int k = 0; k < 256; ++k) {
    const double a = Angle::degrees(30 + 120 * (k + 0.5) / 256).radians();
    light.push_back(2.0 / 3 * (std::sin(a) + (pi - a) * std::cos(a)) / pi);
  }
  std::nth_element(light.begin(), light.begin() + 128, light.end());
  EXPECT_NEAR(typical_light(ball)[1], light[128], 5e-3 * light[128]); // facets for a sphere
}

TEST(LightModel, StopsWhenAsked) {
  const std::atomic<bool> stop{true};
  for (const LightMethod method : {LightMethod::Rays, LightMethod::Masks, LightMethod::Auto}) {
    StokesTable out;
    EXPECT_FALSE(model({.method = method})->evaluate(many_poses(5), out, {false, false, 1, &stop}));
  }
}

} // namespace
} // namespace umov
