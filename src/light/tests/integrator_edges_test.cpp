// Poses at the edge of what is defined, shadows with a closed form, sides, glints.

#include "light/tests/integrator_cases.h"

namespace umov {
namespace {

using namespace cases;

std::vector<Material> gold() { return {interface_of("paper_au", 50)}; }

TEST(IntegratorEdges, PhaseZeroHasNoPolarizationAndIsApproachedSmoothly) {
  const Integrator sphere(scene_of(make_sphere(1, 2000), NormalMode::Flat, gold()));
  const Vec3<Body> sun = random_pose(1).sun, aside = any_perpendicular(sun);
  const auto at = sphere.evaluate({sun, sun}, {}).bands[0];
  const auto near = sphere.evaluate({sun, normalized(sun + 1e-12 * aside)}, {}).bands[0];
  EXPECT_GT(at.stokes.i, 0);
  EXPECT_LE(std::abs(at.stokes.q), 1e-15 * at.stokes.i);
  EXPECT_EQ(at.stokes.u, 0);
  EXPECT_NEAR(near.stokes.i, at.stokes.i, 1e-10 * at.stokes.i);
  EXPECT_NEAR(near.stokes.q, 0, 1e-15 * at.stokes.i);
}

TEST(IntegratorEdges, PhaseOf180IsDarkForAConvexBody) {
  const Integrator sphere(scene_of(make_sphere(1, 2000), NormalMode::Flat, gold()));
  const Vec3<Body> sun = random_pose(1).sun;
  const PoseResult result = sphere.evaluate({sun, -sun}, {});
  EXPECT_TRUE(result.is_dark);
  EXPECT_EQ(result.bands[0].stokes.i, 0);
  EXPECT_EQ(result.bands[0].stokes.q, 0);
  EXPECT_EQ(result.glint_share, 0);
  const PoseResult near =
      sphere.evaluate({sun, normalized(-sun + 1e-12 * any_perpendicular(sun))}, {});
  EXPECT_GE(near.bands[0].stokes.i, 0);
  EXPECT_LT(near.bands[0].stokes.i, 1e-9);
}

TEST(IntegratorEdges, EdgeOnPlateIsFiniteAndNotNegative) {
  for (const Material &material :
       {gold()[0], white_lambert(), interface_of("paper_al", 0), interface_of("paper_al", 1e6)}) {
    const Integrator plate(scene_of(make_plate(1, 1, false), NormalMode::Flat, {material}));
    for (const double z : {0.0, 1e-300, -1e-300, 4.9e-324, 1e-17}) {
      const PoseResult result = plate.evaluate({{1, 0, z}, {0.6, 0.8, z}}, {});
      EXPECT_GE(result.bands[0].stokes.i, 0);
      EXPECT_LT(result.bands[0].stokes.i, 1e-12);
      EXPECT_LE(std::abs(result.bands[0].stokes.q), result.bands[0].stokes.i);
    }
  }
}

TEST(IntegratorEdges, FacetWithoutAreaAddsNothing) {
  Scene scene = scene_of(sheet(0, 1, 0, 1, 0, "sheet"), NormalMode::Flat, {white_lambert()});
  const Pose pose{{0, 0, 1}, {0, 0.6, 0.8}};
  const double before = Integrator(scene).evaluate(pose, {}).bands[0].stokes.i;
  scene.mesh.triangles.push_back(scene.mesh.triangles[0]);
  scene.mesh.triangles.back().vertex = {0, 1, 1};
  EXPECT_NEAR(Integrator(scene).evaluate(pose, {}).bands[0].stokes.i, before, 1e-3 * before);
}

/// Area of the union of two rectangles of one size (w x h) whose corners differ by (dx, dy).
double union_area(double w, double h, double dx, double dy) {
  const double x = std::max(0.0, w - std::abs(dx)), y = std::max(0.0, h - std::abs(dy));
  return 2 * w * h - x * y;
}

TEST(IntegratorEdges, ShadowAndMaskOfAPlateAreJoinedAtTheSamePoint) {
  // A sheet 1 x 1 floats at height 1 over a sheet 12 x 12. It hides two unit squares of the large
  // one, shifted by -l_xy/l_z and -v_xy/v_z; what is left is 144 minus the area of their union.
  const Mesh mesh = joined(sheet(-6, 6, -6, 6, 0, "floor"), sheet(-.5, .5, -.5, .5, 1, "roof"));
  const Integrator integrator(scene_of(mesh, NormalMode::Flat, {white_lambert()}));
  EXPECT_FALSE(integrator.is_convex());
  IntegrationOptions fine;
  fine.accuracy = 2e-4;
  int covered = 0;
  constexpr int poses = 40;
  for (int i = 0; i < poses; ++i) {
    const auto u = uniform4(5, 1, static_cast<std::uint64_t>(i));
    const Vec3<Body> sun = normalized(Vec3<Body>{3 * (u[0] - .5), 3 * (u[1] - .5), 1});
    const Vec3<Body> observer = normalized(Vec3<Body>{3 * (u[2] - .5), 3 * (u[3] - .5), 1});
    const double left = 144 - union_area(1, 1, 3 * (u[0] - u[2]), 3 * (u[1] - u[3]));
    const double per_area = sun.z * observer.z / pi;
    const PoseResult result = integrator.evaluate({sun, observer}, fine);
    EXPECT_NEAR(result.slot_i[2 * 3 + 1], per_area, 1e-12); // the roof is hidden by nothing
    const double difference = std::abs(result.slot_i[1] - left * per_area);
    // Twice the half-width is 3.9 standard errors: 4e-3 to happen once in 40 poses.
    EXPECT_LT(difference, 2 * result.bands[1].half_width.i) << i;
    EXPECT_LE(result.bands[1].half_width.i, 3e-4 * result.bands[1].stokes.i);
    covered += difference <= result.bands[1].half_width.i ? 1 : 0;
  }
  EXPECT_GE(covered, 33); // 95 % of 40 is 38; fewer than 33 has a chance of 2e-3
}

TEST(IntegratorEdges, BackOfASheetIsSeenWithItsOwnMaterial) {
  Diagnostics diagnostics;
  const auto scene = make_scene(sheet(0, 1, 0, 1, 0, "sheet"), NormalMode::Flat, three_bands(),
                                {white_lambert()}, gold(), diagnostics);
  ASSERT_TRUE(scene);
  const Integrator plate(*scene);
  const Vec3<Body> sun{0, 0, 1}, observer{0, 0.6, 0.8};
  EXPECT_EQ(plate.evaluate({sun, observer}, {}).bands[0].stokes.q, 0);
  EXPECT_GT(plate.evaluate({-sun, -observer}, {}).bands[0].stokes.q, 0);
}

TEST(IntegratorEdges, NothingLitAndSeenIsDark) {
  const Integrator plate(scene_of(sheet(0, 1, 0, 1, 0, "sheet"), NormalMode::Flat, gold()));
  const PoseResult result = plate.evaluate({{0, 0, 1}, {0, 0.6, -0.8}}, {});
  EXPECT_TRUE(result.is_dark);
  EXPECT_EQ(result.bands[0].stokes.i, 0);
  // Hidden rather than turned away: a small sheet between a larger one and the Sun.
  const Mesh mesh = joined(sheet(-1, 1, -1, 1, 0, "hidden"), sheet(-9, 9, -9, 9, 1, "lid"));
  const PoseResult lid = Integrator(scene_of(mesh, NormalMode::Flat, gold()))
                             .evaluate({{0, 0, 1}, {0, 0.6, -0.8}}, {});
  EXPECT_TRUE(lid.is_dark);
}

TEST(IntegratorEdges, GlintOfAFlatWithinItsLobe) {
  const Integrator plate(
      scene_of(sheet(0, 1, 0, 1, 0, "sheet"), NormalMode::Flat, {interface_of("paper_al", 200)}));
  const auto share = [&](double tilt_deg) { // half vector tilted from the normal
    const double t = Angle::degrees(tilt_deg).radians(), a = Angle::degrees(30).radians();
    const Vec3<Body> sun{std::sin(t + a), 0, std::cos(t + a)};
    const Vec3<Body> observer{std::sin(t - a), 0, std::cos(t - a)};
    return plate.evaluate({sun, observer}, {}).glint_share;
  };
  // D halves at acos(2^(-1/200)) = 4.768 deg; half the Sun's radius of 0.2665 deg more is 4.901.
  EXPECT_NEAR(share(0), 1, 1e-12);
  EXPECT_NEAR(share(4.89), 1, 1e-12);
  EXPECT_EQ(share(4.92), 0);
}

TEST(IntegratorEdges, ALobeAsWideAsAPaintsMirrorsNothing) {
  // cos^m of half width acos(2^(-1/m)): 12.0 deg at m = 31, beyond .2 rad = 11.46 deg; 11.1 at 36.
  for (const double m : {31., 36.}) {
    const Integrator plate(
        scene_of(sheet(0, 1, 0, 1, 0, "sheet"), NormalMode::Flat, {interface_of("paper_al", m)}));
    const Vec3<Body> sun{0.6, 0, 0.8}, observer{-0.6, 0, 0.8};
    EXPECT_NEAR(plate.evaluate({sun, observer}, {}).glint_share, m > 33 ? 1 : 0, 1e-12) << m;
  }
}

} // namespace
} // namespace umov
