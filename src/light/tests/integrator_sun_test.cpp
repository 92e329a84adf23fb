// The Sun as a disk, by mesh.

#include "core/tests/anchors.h"
#include "light/tests/integrator_cases.h"

#include <algorithm>

namespace umov::cases {
namespace {

constexpr double radius = 0.2665 * pi / 180; // the Sun from 1 au

Material mirror() {
  Material out;
  out.index = constant_index({1, 1e9}); // F = 1
  out.distribution = {"mirror", {}, {}, {}, {}};
  return out;
}

TEST(IntegratorSun, MirrorPlateShowsTheDisk) {
  // J = F A cos(incidence)/Omega inside the cone of the image, nothing outside.
  const Integrator integrator(scene_of(make_plate(1, 1, false), NormalMode::Flat, {mirror()}));
  const double omega = 2 * pi * (1 - std::cos(radius));
  for (const double theta : {10., 60.})
    for (const double off : {0., 0.8, 1.2}) {
      const double i = theta * pi / 180, o = i + off * radius;
      const Pose pose{{std::sin(i), 0, std::cos(i)}, {-std::sin(o), 0, std::cos(o)}, radius};
      const double j = integrator.evaluate(pose, {}).bands[0].stokes.i;
      if (off < 1)
        EXPECT_NEAR(j, std::cos(o) / omega, 1e-4 * j) << theta << " " << off;
      else
        EXPECT_LT(j, 1e-6 / omega);
    }
}

TEST(IntegratorSun, MirrorCylinderMatchesThePrintedValue) {
  // R = 1, L = 2, F = 1, theta_l = 60, theta_v = 120, phi = 80 from the axis.
  const double expected = anchor("mirror_cylinder");
  const Mesh mesh = make_cylinder(1, 2, 256);
  const Integrator integrator(scene_of(mesh, NormalMode::Smooth, {mirror()}));
  const auto from_axis = [](double theta, double phi) {
    const double t = theta * pi / 180, p = phi * pi / 180;
    return Vec3<Body>{std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
  };
  const PoseResult light = integrator.evaluate({from_axis(60, 0), from_axis(120, 80), radius}, {});
  EXPECT_NEAR(light.bands[0].stokes.i, expected, 0.01 * expected);
  EXPECT_NEAR(light.bands[0].stokes.i, expected,
              3 * light.bands[0].half_width.i + 5e-3 * expected); // the error is told
}

TEST(IntegratorSun, MirrorSphereIsASphere) {
  // A sphere sends F R^2/4 everywhere, whatever the size of the source.
  const Integrator integrator(scene_of(make_sphere(1, 20'000), NormalMode::Smooth, {mirror()}));
  for (const double phase : {20., 90., 140.}) {
    Pose pose = pose_at(3, Angle::degrees(phase));
    pose.sun_radius_rad = radius;
    EXPECT_NEAR(integrator.evaluate(pose, {}).bands[0].stokes.i, 0.25, 0.01 * 0.25) << phase;
  }
}

TEST(IntegratorSun, MattersForNarrowLobesAlone) {
  // The peak of a flat plate falls by the ratio of the widths; a wide lobe does not notice.
  const auto ratio = [](double m) {
    const Integrator integrator(
        scene_of(make_plate(1, 1, false), NormalMode::Flat, {interface_of("paper_al", m)}));
    Pose pose{{0.6, 0, 0.8}, {-0.6, 0, 0.8}};
    const double point = integrator.evaluate(pose, {}).bands[0].stokes.i;
    pose.sun_radius_rad = radius;
    return integrator.evaluate(pose, {}).bands[0].stokes.i / point;
  };
  EXPECT_NEAR(ratio(200), 1, 5e-4);
  // Gaussian lobe and disk of variances rho^2/16 (in plane) and /(16 cos^2): closed form at m =
  // 3000.
  const double k1 = radius * radius / 16, k2 = k1 / 0.64, m = 3000;
  EXPECT_NEAR(ratio(m), 1 / std::sqrt((1 + m * k1) * (1 + m * k2)), 2e-4);
  EXPECT_LT(ratio(1e6), 0.5);
}

TEST(IntegratorSun, ApparentRoughnessOfASphereNearlyCancels) {
  // Gold sphere, m0 = 100: I(425)/I(650), three digits.
  Material gold = interface_of("paper_au", 100);
  gold.apparent_roughness = ApparentRoughness{0.8, 550, std::nullopt};
  const Integrator integrator(scene_of(make_sphere(1, 20'000), NormalMode::Smooth, {gold}));
  for (const AnchorRow &row : Anchors("sphere_colour")) {
    const Angle phase = Angle::degrees(row["phase_deg"]);
    const PoseResult light = integrator.evaluate(pose_at(5, phase), {});
    EXPECT_NEAR(light.bands[0].stokes.i / light.bands[2].stokes.i, row["ratio"], 1e-3)
        << row["phase_deg"];
  }
}

TEST(IntegratorSun, PolarizedBodyLightCancelsInUOnASphere) {
  // U of a body symmetric about the scattering plane cancels; a tilted
  // plate keeps it.
  Material si = builtin_material("paper_asi").value();
  si.body->is_polarized = true;
  const Integrator sphere(scene_of(make_sphere(1, 5000), NormalMode::Smooth, {si}));
  const PoseResult round = sphere.evaluate(pose_at(2, Angle::degrees(70)), {});
  EXPECT_NEAR(round.bands[1].stokes.u / round.bands[1].stokes.i, 0, 1e-3);
  const Integrator plate(scene_of(make_plate(1, 1, false), NormalMode::Flat, {si}));
  const PoseResult flat = plate.evaluate(
      {normalized(Vec3<Body>{0.5, 0, 0.9}), normalized(Vec3<Body>{0, 0.9, 0.5})}, {});
  EXPECT_GT(std::abs(flat.bands[1].stokes.u / flat.bands[1].stokes.i), 0.05);
}

TEST(IntegratorBody, BodyLightMakesPolarizationDependOnShape) {
  // a-Si 550 with the unpolarized body lobe, m = 10: the median of a cube in 200,000 random
  // attitudes, from six faces in closed form, and a sphere. Medians of 3,000 scatter by .004.
  Material si = builtin_material("paper_asi").value();
  si.distribution = blinn_phong(10);
  const Integrator cube(scene_of(make_chamfered_cube(1, 1e-4), NormalMode::Flat, {si}));
  const Integrator sphere(scene_of(make_sphere(1, 20'000), NormalMode::Smooth, {si}));
  for (const AnchorRow &row : Anchors("silicon_cube")) {
    const Angle phase = Angle::degrees(row["phase_deg"]);
    std::vector<double> q;
    for (std::uint64_t i = 0; i < 3000; ++i) {
      const PoseResult light = cube.evaluate(pose_at(i, phase), {});
      if (!light.is_dark && light.bands[1].stokes.i > 1e-12)
        q.push_back(light.bands[1].stokes.q / light.bands[1].stokes.i);
    }
    std::sort(q.begin(), q.end());
    EXPECT_NEAR(q[q.size() / 2], row["cube_median"], .012) << row["phase_deg"];
    const auto round = sphere.evaluate(pose_at(1, phase), {}).bands[1].stokes;
    EXPECT_NEAR(round.q / round.i, row["sphere"], 2e-4) << row["phase_deg"];
  }
}

} // namespace
} // namespace umov::cases
