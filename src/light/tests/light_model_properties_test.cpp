// What holds for every object and every method, tried on random ones: symmetries, scaling,
// physical Stokes vectors. Each property follows from the definition of intensity, so nothing but
// half-widths enters the tolerances.

#include "light/tests/integrator_cases.h"

#include <random>
#include <umov/light/light_model.h>
#include <umov/light/poses.h>

namespace umov {
namespace {

using namespace cases;

constexpr std::uint64_t object_count = 4;
constexpr std::size_t pose_count = 12;

/// A few boxes of random sizes and turns that hide one another, in two materials.
Scene random_object(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Mesh mesh;
  mesh.groups = {"one", "two"};
  for (std::uint32_t part = 0; part < 4; ++part) {
    Mesh box = make_chamfered_cube(0.3 + 0.7 * unit(random), 0.02);
    const Vec3<Body> shift{2 * unit(random) - 1, 2 * unit(random) - 1, 2 * unit(random) - 1};
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto &v : box.positions)
      mesh.positions.push_back(v + shift);
    for (Triangle t : box.triangles) {
      for (std::uint32_t &corner : t.vertex)
        corner += first;
      t.front = t.back = part % 2;
      t.normal = {no_index, no_index, no_index};
      mesh.triangles.push_back(t);
    }
  }
  return scene_of(mesh, NormalMode::Flat, {interface_of("paper_al", 30), white_lambert()});
}

/// What is done to an object, its Sun and its observer together.
using Change = Vec3<Body> (*)(const Vec3<Body> &);

Scene changed(Scene scene, Change change, bool turns_inside_out) {
  for (auto &v : scene.mesh.positions)
    v = change(v);
  if (turns_inside_out) // a mirrored triangle faces the other way unless its order is exchanged
    for (Triangle &t : scene.mesh.triangles)
      std::swap(t.vertex[1], t.vertex[2]);
  return scene;
}

std::vector<Pose> poses_of(std::uint64_t seed) {
  std::vector<Pose> out;
  for (std::size_t k = 0; k < pose_count; ++k)
    out.push_back(random_pose(seed, k, Angle::degrees(25 + 10.0 * static_cast<double>(k))));
  return out;
}

std::vector<Pose> changed(std::vector<Pose> poses, Change change) {
  for (Pose &pose : poses)
    pose = {change(pose.sun), change(pose.observer), pose.sun_radius_rad};
  return poses;
}

StokesTable lit(const Scene &scene, const std::vector<Pose> &poses, LightMethod method) {
  const auto light = make_light(scene, {}, {.method = method, .accuracy = 0.01});
  StokesTable out;
  EXPECT_TRUE((*light)->evaluate(poses, out));
  return out;
}

/// Both within their half-widths of one truth. These are 95 % ones: three of them are missed by one
/// row in millions if errors are normal; masks' are not quite, hence four.
void expect_alike(const StokesTable &a, const StokesTable &b, double factor, double sign_of_u) {
  for (std::size_t at = 0; at < a.i.size(); ++at) {
    constexpr double widths = 4;
    const double slack = 1e-9 * factor * a.i[at];
    EXPECT_NEAR(factor * a.i[at], b.i[at], slack + widths * (factor * a.i_err[at] + b.i_err[at]));
    EXPECT_NEAR(factor * a.q[at], b.q[at], slack + widths * (factor * a.q_err[at] + b.q_err[at]));
    EXPECT_NEAR(sign_of_u * factor * a.u[at], b.u[at],
                slack + widths * (factor * a.u_err[at] + b.u_err[at]));
  }
}

class LightProperties : public testing::TestWithParam<LightMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, LightProperties,
                         testing::Values(LightMethod::Rays, LightMethod::Masks, LightMethod::Auto),
                         [](const auto &method) { return std::string(name_of(method.param)); });

TEST_P(LightProperties, TurningObjectSunAndObserverTogetherChangesNothing) {
  // A turn about (1, 1, 1) by 120 deg and one about z whose tangent of half the angle is 1/2.
  const Change turn = [](const Vec3<Body> &v) {
    return Vec3<Body>{0.6 * v.z - 0.8 * v.x, 0.8 * v.z + 0.6 * v.x, v.y};
  };
  for (std::uint64_t seed = 0; seed < object_count; ++seed) {
    const Scene scene = random_object(seed);
    expect_alike(lit(scene, poses_of(seed), GetParam()),
                 lit(changed(scene, turn, false), changed(poses_of(seed), turn), GetParam()), 1, 1);
  }
}

TEST_P(LightProperties, AMirroredSceneHasTheSameQAndTheOppositeU) {
  // The frame of the scattering plane is mirrored with the scene: its normal is an axial vector.
  const Change mirror = [](const Vec3<Body> &v) { return Vec3<Body>{v.x, -v.y, v.z}; };
  for (std::uint64_t seed = 0; seed < object_count; ++seed) {
    const Scene scene = random_object(seed);
    expect_alike(lit(scene, poses_of(seed), GetParam()),
                 lit(changed(scene, mirror, true), changed(poses_of(seed), mirror), GetParam()), 1,
                 -1);
  }
}

TEST_P(LightProperties, IntensityGrowsWithTheSquareOfTheSize) {
  const Change twice = [](const Vec3<Body> &v) { return 2 * v; };
  for (std::uint64_t seed = 0; seed < object_count; ++seed) {
    const Scene scene = random_object(seed);
    expect_alike(lit(scene, poses_of(seed), GetParam()),
                 lit(changed(scene, twice, false), poses_of(seed), GetParam()), 4, 1);
  }
}

TEST_P(LightProperties, StokesVectorsArePhysical) {
  for (std::uint64_t seed = 0; seed < object_count; ++seed) {
    const StokesTable table = lit(random_object(seed), poses_of(seed), GetParam());
    for (std::size_t at = 0; at < table.i.size(); ++at) {
      EXPECT_GE(table.i[at], 0);
      EXPECT_LE(std::hypot(table.q[at], table.u[at], table.v[at]), table.i[at] * (1 + 1e-6));
      EXPECT_TRUE(std::isfinite(table.i_err[at]) && table.i_err[at] >= 0);
    }
  }
}

} // namespace
} // namespace umov
