// What stands beside poses to Stokes at the seam: sums, light between surfaces at points, blocks.

#include "light/tests/integrator_cases.h"

#include <cmath>
#include <umov/light/between_light.h>
#include <umov/light/blocks.h>
#include <umov/light/engine.h>
#include <umov/light/light_sums.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

using namespace cases;

std::vector<Pose> poses_of(std::size_t count) {
  std::vector<Pose> out;
  for (std::size_t k = 0; k < count; ++k)
    out.push_back(random_pose(5, k, Angle::degrees(60)));
  return out;
}

// The engine itself is what its light is held against: the same sums by the same coefficients, only
// the order of a few products differs.
TEST(LightSums, OfItsOwnMaterialsAreItsLight) {
  const Scene scene = box_wing_scene();
  const auto poses = poses_of(8);
  const auto made = make_sums(scene, {.accuracy = 0.02, .threads = 1});
  ASSERT_TRUE(made) << made.error().text();
  const LightSums *const sums = made->get();
  AbundanceTable table;
  ASSERT_TRUE(sums->evaluate(poses, table));
  const auto materials = sums->tables_for(scene);
  ASSERT_TRUE(materials) << materials.error().text();
  StokesTable applied, direct;
  materials->apply(table, applied);
  Engine(scene, {.masks = masks_for(0.02), .is_lazy = true, .threads = 1}).evaluate(poses, direct);
  ASSERT_EQ(applied.i.size(), direct.i.size());
  for (std::size_t k = 0; k < direct.i.size(); ++k)
    EXPECT_NEAR(applied.i[k], direct.i[k], 1e-12 * direct.i[k]) << k;
  sums->keep_masks(); // without a cache: nothing to be done, nothing said
}

// Below its floor no light is mended by rays: with a floor above all light the sums are those of
// masks alone. Without one, rays change those of dim poses.
TEST(LightSums, OfLightBelowItsFloorAreThoseOfMasks) {
  const Scene scene = box_wing_scene();
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < 100; ++k)
    poses.push_back(random_pose(5, k, Angle::degrees(100 + 0.5 * static_cast<double>(k))));
  const auto sums_with = [&](const SumsOptions &options) {
    const auto made = make_sums(scene, options);
    AbundanceTable out;
    EXPECT_TRUE(made && (*made)->evaluate(poses, out));
    return out.sum;
  };
  const auto masks = sums_with({.accuracy = 0.02, .threads = 1});
  EXPECT_EQ(sums_with({.accuracy_floor = 1e6, .threads = 1}), masks);
  EXPECT_NE(sums_with({.threads = 1}), masks);
}

// As of engines: the masks of a model that has traced them are not traced again, and the sums are
// those of an object alone.
TEST(LightSums, TakeMasksOfTheSameObject) {
  const Scene scene = box_wing_scene();
  const auto poses = poses_of(8);
  const auto model = make_light(scene, {}, {.method = LightMethod::Masks, .threads = 1});
  const auto own = make_sums(scene, {.accuracy = 0.02, .threads = 1});
  const auto alone = make_sums(scene, {.accuracy = 0.02, .threads = 1});
  ASSERT_TRUE(model && own && alone);
  StokesTable light;
  ASSERT_TRUE((*model)->evaluate(poses, {}, light));
  (*own)->take_masks_of(**model);
  AbundanceTable a, b;
  ASSERT_TRUE((*own)->evaluate(poses, a) && (*alone)->evaluate(poses, b));
  EXPECT_EQ(a.sum, b.sum);
}

/// Share of the hemisphere of a point of the floor that the wall x = 0 of `corner` fills: Lambert's
/// sum over the edges, for the parts of the wall on both sides of the point, `c` away from it.
double wall_share(double c, double y) {
  const auto part = [c](double width) {
    const double slant = std::hypot(c, 1.0);
    return (std::atan(width / c) - c / slant * std::atan(width / slant)) / (2 * pi);
  };
  return part(y) + part(1 - y);
}

std::vector<Stokes<ScatteringPlane>> radiance_of(const Mesh &mesh) {
  const std::vector<SurfacePoint> points{{0, 1. / 3, 1. / 3}}; // (2/3, 1/3, 0)
  const Pose along_the_floor{{1, 0, 0}, normalized(Vec3<Body>{1, 0, 1}), 0};
  const Scene scene = scene_of(mesh, NormalMode::Flat, {white_lambert()});
  return make_between_light(scene)->radiance(along_the_floor, points, {2, 100'000, 1}, 0);
}

// The Sun stands in the plane of the floor and square on the wall, which sends 1/pi to all sides;
// the floor has that light alone. 100,000 paths, of which a share F meets the wall: 0.6 % (one
// standard error of a binomial), held to three of them.
TEST(BetweenLight, OfALitWallOnADarkFloorIsItsShareOfTheSky) {
  const double expected = wall_share(2. / 3, 1. / 3) / pi;
  const auto found = radiance_of(corner());
  ASSERT_EQ(found.size(), 3u);
  for (const auto &light : found)
    EXPECT_NEAR(light.i, expected, 0.02 * expected);
  for (const auto &light : radiance_of(sheet(0, 1, 0, 1, 0, "alone")))
    EXPECT_EQ(light.i, 0); // nothing else is there
}

// Chains serve whole lists; a series that shares paths stays short, so that a stop costs little.
TEST(Blocks, AreAsLongAsTheLightAllows) {
  const auto light = make_light(box_wing_scene(), {}, {.method = LightMethod::Rays});
  ASSERT_TRUE(light);
  LightOptions direct, paths, chains;
  paths.bounces = chains.bounces = 3;
  paths.between = BetweenMethod::Paths;
  chains.between = BetweenMethod::Chains;
  EXPECT_LT(series_block(**light, direct), list_block(**light, direct));
  EXPECT_LT(list_block(**light, paths), list_block(**light, chains));
  EXPECT_LE(series_block(**light, paths), list_block(**light, paths));
}

} // namespace
} // namespace umov
