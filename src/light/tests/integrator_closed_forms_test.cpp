// Meshes against the closed forms of docs/theory: point Sun, unit irradiance, [m2/sr].

#include "core/tests/anchors.h"
#include "light/tests/integrator_cases.h"

namespace umov {
namespace {

using namespace cases;

double intensity(const Integrator &integrator, const Pose &pose) {
  return integrator.evaluate(pose, {}).bands[1].stokes.i;
}

/// (2/3 pi)(sin a + (pi - a) cos a): Lambert sphere of radius 1 and reflectance 1 (Russell 1916).
double lambert_sphere(Angle phase) {
  const double a = phase.radians();
  return 2 / (3 * pi) * (std::sin(a) + (pi - a) * std::cos(a));
}

TEST(IntegratorClosedForms, LambertSphereConvergesWithSecondOrder) {
  for (const double phase_deg : {0.0, 30.0, 60.0, 90.0, 120.0}) {
    const Angle phase = Angle::degrees(phase_deg);
    double error[2] = {0, 0};
    for (int level = 0; level < 2; ++level) {
      const Integrator sphere(
          scene_of(make_sphere(1, level == 0 ? 4000 : 64000), NormalMode::Flat, {white_lambert()}));
      EXPECT_TRUE(sphere.is_convex());
      error[level] = relative(intensity(sphere, pose_at(3, phase)), lambert_sphere(phase));
    }
    // 64,000 facets: edge length 0.02, area short by about (edge^2) / 5 = 1e-4 (twice that where
    // the terminator cuts facets). Edges a quarter as long: 16 times less, 10 allows for the cut.
    EXPECT_LT(error[1], 4e-4) << phase_deg;
    EXPECT_LT(error[1], error[0] / 10) << phase_deg;
  }
}

TEST(IntegratorClosedForms, LambertPlateIsExact) {
  const Integrator plate(scene_of(make_plate(2, 3, false), NormalMode::Flat, {white_lambert()}));
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Pose pose = random_pose(i, 0, 170);
    const double cosines = pose.sun.z * pose.observer.z; // both sides scatter
    const double expected = cosines > 0 ? 6 / pi * cosines : 0;
    // Six numbers are multiplied: a few roundings.
    EXPECT_NEAR(intensity(plate, pose), expected, 1e-14) << i;
  }
}

Pose cylinder_pose() { // theta_l = 60, theta_v = 120, azimuths 80 deg apart
  const double s = std::sqrt(0.75), azimuth = Angle::degrees(80).radians();
  return {{s, 0, 0.5}, {s * std::cos(azimuth), s * std::sin(azimuth), -0.5}};
}

TEST(IntegratorClosedForms, LambertCylinderConverges) {
  // (rho/pi) R L sin sin (1/2)((pi - phi) cos phi + sin phi); six digits.
  const double expected = anchor("lambert_cylinder");
  double before = 1;
  for (const std::size_t sides : {24u, 96u, 768u}) {
    const Integrator tube(
        scene_of(make_cylinder(1, 2, sides), NormalMode::Flat, {white_lambert()}));
    const double error = std::abs(intensity(tube, cylinder_pose()) - expected);
    EXPECT_LT(error, before);
    before = error;
  }
  EXPECT_LT(before, 5e-6);
}

TEST(IntegratorClosedForms, SmoothLambertCylinderOf48Sides) {
  const Integrator tube(scene_of(make_cylinder(1, 2, 48), NormalMode::Smooth, {white_lambert()}));
  const PoseResult result = tube.evaluate(cylinder_pose(), {});
  EXPECT_EQ(result.rays, 0u);
  EXPECT_LT(relative(result.bands[1].stokes.i, anchor("lambert_cylinder")),
            2e-4); // patch area: fourth order
}

/// Relative errors of J 4 / (R^2 F) of a rough sphere with flat or smooth normals, sorted, over
/// attitudes and phases.
std::vector<double> rough_sphere_errors(std::size_t facets, NormalMode normals, double exponent,
                                        double expected) {
  const Scene scene =
      scene_of(make_sphere(1, facets), normals, {interface_of("paper_au", exponent)});
  const Integrator sphere(scene);
  std::vector<double> errors;
  for (std::uint64_t i = 0; i < 8; ++i)
    for (const double phase : {20.0, 60.0, 90.0, 120.0}) {
      const Angle angle = Angle::degrees(phase);
      const double a = scene.front[0].fresnel(1, std::cos(angle.radians())).a;
      errors.push_back(relative(4 * intensity(sphere, pose_at(i, angle)) / a, expected));
    }
  std::sort(errors.begin(), errors.end());
  return errors;
}

double worst_rough_sphere(std::size_t facets, NormalMode normals, double exponent,
                          double expected) {
  return rough_sphere_errors(facets, normals, exponent, expected).back();
}

// J -> R^2 F / (4 <h.n>) = R^2 F (m + 2) / (4 (m + 1)) while no facet is blocked (the table
// rough_sphere of anchors shows where: at m >= 50 up to 90 deg, at m = 200 and 1000 beyond 120).
TEST(IntegratorClosedForms, RoughSphereOf40000Facets) {
  const auto broad = rough_sphere_errors(40000, NormalMode::Flat, 200, 202.0 / 201);
  const auto narrow = rough_sphere_errors(40000, NormalMode::Flat, 1000, 1002.0 / 1001);
  EXPECT_LT(broad.back(), 5e-4);
  EXPECT_LT(narrow.back(), 2e-3);
}

TEST(IntegratorClosedForms, RoughSphereIsSecondOrderInEdgeLength) {
  const double coarse = worst_rough_sphere(10000, NormalMode::Flat, 200, 202.0 / 201);
  const double fine = worst_rough_sphere(160000, NormalMode::Flat, 200, 202.0 / 201);
  EXPECT_GT(coarse / fine, 10); // 16 for pure second order; facets are not all of one shape
}

TEST(IntegratorClosedForms, SmoothRoughSphereOf5000Facets) {
  EXPECT_LT(worst_rough_sphere(5000, NormalMode::Smooth, 200, 202.0 / 201), 2e-4);
  EXPECT_LT(worst_rough_sphere(5000, NormalMode::Smooth, 1000, 1002.0 / 1001), 2e-4);
}

TEST(IntegratorClosedForms, RoughSphereAtBroadLobes) {
  // Half a unit of the last digit, and the facets' part (smooth patches: fourth order).
  const Anchors table("rough_sphere");
  for (const char *m : {"4", "10"}) {
    const Scene scene = scene_of(make_sphere(1, 5000), NormalMode::Smooth,
                                 {interface_of("paper_au", AnchorRow::number(m))});
    const Integrator sphere(scene);
    for (const char *phase : {"60", "120"}) {
      const Angle angle = Angle::degrees(AnchorRow::number(phase));
      const double a = scene.front[0].fresnel(1, std::cos(angle.radians())).a;
      EXPECT_NEAR(4 * intensity(sphere, pose_at(5, angle)) / a, table.row({m, phase})["j"], 1.5e-4);
    }
  }
}

TEST(IntegratorClosedForms, SphereStokesOfGoldAndAluminium) {
  // (M00, M10) at 90 deg, R = 1, seven digits.
  for (const AnchorRow &row : Anchors("sphere_stokes")) {
    const std::string &name = row.text("material");
    const Integrator sphere(scene_of(make_sphere(1, 20000), NormalMode::Smooth,
                                     {interface_of(name.c_str(), row["m"])}));
    const PoseResult result = sphere.evaluate(pose_at(11, Angle::degrees(90)), {});
    const auto &light = result.bands[band_of(row)].stokes;
    // Mylar's lobe of m = 10 is wide and its last digit is 4e-6 of it.
    EXPECT_LT(relative(light.i, row["i"]), 3e-5) << name;
    EXPECT_LT(relative(light.q, row["q"]), 3e-5) << name;
  }
}

TEST(IntegratorClosedForms, EllipsoidLikeAMirror) {
  // J = F / (4 K(h)): semi-axes 1, 2, 3, l = x, v = (0, .6, .8), F = 1; at m = 10,000 the
  // lobe adds (m + 2) / (m + 1) and second-order terms, together within 0.2 %.
  const Scene scene = scene_of(make_ellipsoid(1, 2, 3, 640000), NormalMode::Flat,
                               {interface_of("paper_al", 10000)});
  const double a = scene.front[0].fresnel(1, 0).a;
  const Integrator ellipsoid(scene);
  EXPECT_LT(
      relative(intensity(ellipsoid, {{1, 0, 0}, {0, 0.6, 0.8}}) / a, anchor("mirror_ellipsoid")),
      2e-3);
}

TEST(IntegratorClosedForms, SmoothEllipsoidNeedsFewFacets) {
  const Scene scene = scene_of(make_ellipsoid(1, 2, 3, 20000), NormalMode::Smooth,
                               {interface_of("paper_al", 10000)});
  const double a = scene.front[0].fresnel(1, 0).a;
  const Integrator ellipsoid(scene);
  EXPECT_LT(
      relative(intensity(ellipsoid, {{1, 0, 0}, {0, 0.6, 0.8}}) / a, anchor("mirror_ellipsoid")),
      2e-3);
}

} // namespace
} // namespace umov
