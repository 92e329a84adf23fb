// What must hold for any shape: symmetries, edges and the same bytes for any number of threads.

#include "light/tests/integrator_cases.h"

#include <algorithm>
#include <cstring>
#include <umov/core/rotation.h>

namespace umov {
namespace {

using namespace cases;

/// A concave body of two materials.
Mesh two_boxes() {
  Mesh a = make_chamfered_cube(1, 0.1), b = make_chamfered_cube(0.6, 0.05);
  for (Vec3<Body> &p : b.positions)
    p += Vec3<Body>{1.1, 0.2, 0.1};
  b.groups[0] = "small";
  return joined(a, b);
}

std::vector<Material> gold_and_silicon() {
  return {*builtin_material("paper_au"), *builtin_material("paper_asi")};
}

TEST(IntegratorProperties, ConvexMeshesTakeNoRaysAndConcaveOnesDo) {
  const Integrator convex(scene_of(make_sphere(1, 500), NormalMode::Flat, gold_and_silicon()));
  const Integrator concave(scene_of(two_boxes(), NormalMode::Flat, gold_and_silicon()));
  EXPECT_TRUE(convex.is_convex());
  EXPECT_FALSE(concave.is_convex());
  EXPECT_EQ(convex.evaluate(random_pose(1), {}).rays, 0u);
  EXPECT_GT(concave.evaluate(random_pose(1), {}).rays, 0u);
}

TEST(IntegratorProperties, SameBytesForAnyNumberOfThreads) {
  const Integrator integrator(scene_of(two_boxes(), NormalMode::Flat, gold_and_silicon()));
  std::vector<Pose> poses;
  for (std::uint64_t i = 0; i < 40; ++i)
    poses.push_back(random_pose(i));
  const auto one = integrator.evaluate(poses, {}, 1);
  for (const unsigned threads : {2u, 8u}) {
    const auto many = integrator.evaluate(poses, {}, threads);
    for (std::size_t i = 0; i < poses.size(); ++i)
      EXPECT_EQ(std::memcmp(one[i].bands.data(), many[i].bands.data(),
                            one[i].bands.size() * sizeof(BandResult)),
                0);
  }
}

TEST(IntegratorProperties, ScalesWithTheSquareOfTheSize) {
  Mesh mesh = make_hst();
  const Integrator small(scene_of(mesh, NormalMode::Flat, gold_and_silicon()));
  for (Vec3<Body> &p : mesh.positions)
    p = p * 1000.0;
  const Integrator large(scene_of(mesh, NormalMode::Flat, gold_and_silicon()));
  for (std::uint64_t i = 0; i < 10; ++i) {
    const Pose pose = random_pose(i);
    const auto a = small.evaluate(pose, {}).bands[0], b = large.evaluate(pose, {}).bands[0];
    EXPECT_NEAR(b.stokes.i, 1e6 * a.stokes.i, 1e6 * (a.half_width.i + 1e-12 * a.stokes.i) * 2);
  }
}

TEST(IntegratorProperties, SunAndObserverCanBeExchanged) {
  const Integrator integrator(scene_of(two_boxes(), NormalMode::Smooth, gold_and_silicon()));
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Pose pose = random_pose(i);
    const auto a = integrator.evaluate(pose, {}).bands[1];
    const auto b = integrator.evaluate({pose.observer, pose.sun}, {}).bands[1];
    EXPECT_NEAR(a.stokes.i, b.stokes.i, 2 * (a.half_width.i + b.half_width.i)); // points differ
  }
}

TEST(IntegratorProperties, TurningTheWholeSceneChangesNothing) {
  // A convex body, so that no random points enter: 1e-12 of rounding.
  Mesh mesh = make_chamfered_cube(1, 0.1);
  const Integrator before(scene_of(mesh, NormalMode::Flat, gold_and_silicon()));
  const auto turn = rotation_from<Body, Body>({0.5, -0.1, 0.7, std::sqrt(1 - 0.25 - 0.01 - 0.49)});
  for (Vec3<Body> &p : mesh.positions)
    p = turn * p;
  for (Vec3<Body> &n : mesh.normals)
    n = turn * n;
  const Integrator after(scene_of(mesh, NormalMode::Flat, gold_and_silicon()));
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Pose pose = random_pose(i);
    const auto a = before.evaluate(pose, {}).bands[2].stokes;
    const auto b = after.evaluate({turn * pose.sun, turn * pose.observer}, {}).bands[2].stokes;
    EXPECT_NEAR(b.i, a.i, 1e-10 * a.i);
    EXPECT_NEAR(b.q, a.q, 1e-10 * a.i);
  }
}

TEST(IntegratorProperties, ASheetIsTheSumOfItsParts) {
  const Mesh whole = make_plate(2, 1, false);
  Mesh one = whole, other = whole;
  one.triangles.pop_back();
  other.triangles.erase(other.triangles.begin());
  const Integrator all(scene_of(whole, NormalMode::Flat, gold_and_silicon()));
  const Integrator a(scene_of(one, NormalMode::Flat, gold_and_silicon()));
  const Integrator b(scene_of(other, NormalMode::Flat, gold_and_silicon()));
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Pose pose = random_pose(i);
    const double sum =
        a.evaluate(pose, {}).bands[0].stokes.i + b.evaluate(pose, {}).bands[0].stokes.i;
    EXPECT_NEAR(all.evaluate(pose, {}).bands[0].stokes.i, sum, 1e-12 * sum);
  }
}

TEST(IntegratorProperties, OrderOfFacesDoesNotMatter) {
  Mesh mesh = make_sphere(1, 3000);
  const Integrator before(scene_of(mesh, NormalMode::Flat, gold_and_silicon()));
  std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  const Integrator after(scene_of(mesh, NormalMode::Flat, gold_and_silicon()));
  for (std::uint64_t i = 0; i < 20; ++i) {
    const double a = before.evaluate(random_pose(i), {}).bands[0].stokes.i;
    EXPECT_NEAR(after.evaluate(random_pose(i), {}).bands[0].stokes.i, a, 1e-12 * a);
  }
}

TEST(IntegratorEdges, PhaseZeroAnd180) {
  const Integrator sphere(scene_of(make_sphere(1, 2000), NormalMode::Flat, gold_and_silicon()));
  const Vec3<Body> l = normalized(Vec3<Body>{0.3, -0.4, 0.8});
  const PoseResult full = sphere.evaluate({l, l}, {});
  EXPECT_FALSE(full.is_dark);
  EXPECT_GT(full.bands[0].stokes.i, 0);
  EXPECT_EQ(full.bands[0].stokes.q, 0);
  EXPECT_EQ(full.bands[0].stokes.u, 0);
  const PoseResult back = sphere.evaluate({l, -l}, {});
  EXPECT_TRUE(std::isfinite(back.bands[0].stokes.i));
  EXPECT_EQ(back.bands[0].stokes.q, 0);
  // Continuous from 1e-12 rad on.
  const Vec3<Body> near = normalized(l + 1e-12 * any_perpendicular(l));
  const auto close = sphere.evaluate({l, near}, {}).bands[0].stokes;
  EXPECT_NEAR(close.i, full.bands[0].stokes.i, 1e-9 * close.i);
  EXPECT_NEAR(close.q, 0, 1e-9 * close.i);
}

TEST(IntegratorEdges, NothingLitAndSeenIsDarkNotUndefined) {
  const Integrator plate(scene_of(make_plate(1, 1, false), NormalMode::Flat, gold_and_silicon()));
  const PoseResult dark = plate.evaluate({{0, 0.6, 0.8}, {0, 0.6, -0.8}}, {});
  EXPECT_TRUE(dark.is_dark);
  EXPECT_EQ(dark.bands[0].stokes.i, 0);
  const PoseResult edge_on = plate.evaluate({{1, 0, 0}, {0, 1, 0}}, {});
  EXPECT_EQ(edge_on.bands[0].stokes.i, 0);
}

TEST(IntegratorEdges, BothSidesOfASheetScatter) {
  // A two-sided sheet shows each side's own material; Q/I tells which.
  const Scene scene = scene_of(make_plate(1, 1, true), NormalMode::Flat,
                               {interface_of("paper_au", 200), interface_of("paper_al", 200)});
  const Integrator sheet(scene);
  for (const double side : {1.0, -1.0}) {
    const Pose pose{normalized(Vec3<Body>{0.5, 0, side}), normalized(Vec3<Body>{-0.5, 0.1, side})};
    const auto s = sheet.evaluate(pose, {}).bands[1].stokes;
    const auto f =
        (side > 0 ? scene.front[0] : scene.back[0]).fresnel(1, dot(pose.sun, pose.observer));
    const auto expected = side > 0 ? f : scene.front[1].fresnel(1, dot(pose.sun, pose.observer));
    EXPECT_NEAR(s.q / s.i, expected.b / expected.a, 1e-12);
  }
}

TEST(IntegratorEdges, GrazingDirectionsStayFinite) {
  const Integrator body(scene_of(two_boxes(), NormalMode::Flat, gold_and_silicon()));
  for (const double tilt : {0.0, 1e-300, 1e-16, 1e-12, 1e-8})
    for (const double sign : {-1.0, 1.0}) {
      const Pose pose{normalized(Vec3<Body>{1, 0, sign * tilt}),
                      normalized(Vec3<Body>{0, 1, tilt})};
      for (const BandResult &band : body.evaluate(pose, {}).bands) {
        EXPECT_TRUE(std::isfinite(band.stokes.i) && band.stokes.i >= 0);
        EXPECT_LE(std::abs(band.stokes.q), band.stokes.i * (1 + 1e-12));
      }
    }
}

} // namespace
} // namespace umov
