// A finer mesh of the same curved part: as many classes, the same light.

#include "engine_cases.h"

namespace umov::cases {
namespace {

Engine bare_engine(const Mesh &mesh, double m) {
  return engine_of(scene_of(mesh, NormalMode::Smooth, {interface_of("paper_au", m)}),
                   Visibility::None);
}
std::size_t classes_of(const Mesh &mesh, double m) { return bare_engine(mesh, m).facts().classes; }

// Element by element, four times the sides of a tube of 192 are four times the classes, and 320,000
// triangles of a sphere sixteen times those of 20,000. Coarse meshes are cut to elements that turn
// by up to a lobe's width, with a count that depends on how they halve: a fifth for that.
TEST(RefinedMeshes, HaveAsManyClasses) {
  const std::size_t tube = classes_of(make_cylinder(1, 2, 48), 200);
  for (const std::size_t sides : {768u, 3072u})
    EXPECT_LE(classes_of(make_cylinder(1, 2, sides), 200), tube * 6 / 5) << sides;
  EXPECT_LE(classes_of(make_sphere(1, 320'000), 200),
            classes_of(make_sphere(1, 20'000), 200) * 6 / 5);
}

/// Largest difference of I in parts of it, or of a thousandth of the brightest.
double worst_change(const Engine &coarse, const Engine &fine) {
  std::vector<Pose> poses;
  for (double phase = 20; phase <= 150; phase += 10)
    for (std::uint64_t i = 0; i < 8; ++i)
      poses.push_back(pose_at(i, Angle::degrees(phase)));
  const StokesTable a = evaluated(coarse, poses), b = evaluated(fine, poses);
  const double least = 1e-3 * *std::max_element(a.i.begin(), a.i.end());
  double worst = 0;
  for (std::size_t k = 0; k < a.i.size(); ++k)
    worst = std::max(worst, std::abs(b.i[k] - a.i[k]) / std::max(a.i[k], least));
  return worst;
}

// The closed form of a sphere under a point Sun (J = R^2 F (m + 2)/(4 (m + 1))) is the same for
// every attitude and phase: what a mesh misses is its own. The bound is that of the coarse mesh
// (Engine.SmoothSphereAndCylinderMatchQuadrature).
TEST(RefinedMeshes, OfASphereKeepTheClosedForm) {
  for (const std::size_t triangles : {80'000u, 320'000u}) {
    const Scene scene =
        scene_of(make_sphere(1, triangles), NormalMode::Smooth, {interface_of("paper_au", 200)});
    const Engine engine = engine_of(scene, Visibility::None);
    for (double phase = 20; phase <= 150; phase += 26)
      for (std::uint64_t i = 0; i < 4; ++i) {
        const Angle angle = Angle::degrees(phase);
        const double a = scene.front[0].fresnel(1, std::cos(angle.radians())).a;
        const double j = evaluated(engine, {pose_at(i, angle)}).at(0, 1).stokes.i;
        EXPECT_NEAR(4 * j / (a * 202.0 / 201), 1, 5e-3) << triangles << " at " << phase;
      }
  }
}

// A regular polygon of 48 sides has caps .3 % smaller than a circle's: that is the mesh's, so that
// tubes are compared from 192 sides on, where it is 2e-4. What joining may miss: the midpoint rule
// over w = T sqrt(3)/4, T the width of a Gaussian lobe, is w^2/24 T^-2 = .8 % off at the lobe's
// peak, of which neighbours cancel most.
TEST(RefinedMeshes, OfATubeKeepItsLight) {
  EXPECT_LT(worst_change(bare_engine(make_cylinder(1, 2, 192), 200),
                         bare_engine(make_cylinder(1, 2, 768), 200)),
            3e-3);
}

} // namespace
} // namespace umov::cases
