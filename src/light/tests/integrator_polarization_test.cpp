// Polarization of the whole object: one material, and fields reflected in three dimensions.

#include "light/tests/integrator_cases.h"

#include <array>
#include <complex>

namespace umov {
namespace {

using namespace cases;
using Complex = std::complex<double>;
using Field = std::array<Complex, 3>;

Complex along(const Field &field, Vec3<Body> axis) {
  return field[0] * axis.x + field[1] * axis.y + field[2] * axis.z;
}

Field field_along(Vec3<Body> axis, Complex amplitude) {
  return {amplitude * axis.x, amplitude * axis.y, amplitude * axis.z};
}

/// The field of a plane wave after a mirror with normal `mirror`, amplitudes from Snell's law with
/// a complex angle of refraction (Born & Wolf 1999, section 1.5.2), not from the library's form.
Field reflected(const Field &field, Vec3<Body> travel, Vec3<Body> mirror, Complex index) {
  const double c = -dot(travel, mirror);
  const Complex sine_t = std::sqrt(1 - c * c) / index, cosine_t = std::sqrt(1.0 - sine_t * sine_t);
  const Complex r_s = (c - index * cosine_t) / (c + index * cosine_t);
  const Complex r_p = (index * c - cosine_t) / (index * c + cosine_t);
  const Vec3<Body> out = travel + 2 * c * mirror;
  const Vec3<Body> s = normalized(cross(travel, out));
  const Field at_s = field_along(s, r_s * along(field, s));
  const Field at_p = field_along(cross(out, s), r_p * along(field, cross(travel, s)));
  return {at_s[0] + at_p[0], at_s[1] + at_p[1], at_s[2] + at_p[2]};
}

/// Stokes of unpolarized sunlight after one mirror, as two incoherent waves polarized along
/// arbitrary axes; read in the axes (s, p) of the observer's beam.
Stokes<ScatteringPlane> mirror_light(const Pose &pose, Complex index, Vec3<Body> mirror) {
  const Vec3<Body> travel = -pose.sun;
  const Vec3<Body> first = any_perpendicular(travel), second = cross(travel, first);
  const Vec3<Body> s = normalized(cross(pose.observer, pose.sun)), p = cross(pose.observer, s);
  Stokes<ScatteringPlane> out;
  for (const Vec3<Body> &axis : {first, second}) {
    const Field field = reflected(field_along(axis, 1), travel, mirror, index);
    const Complex e_s = along(field, s), e_p = along(field, p);
    out += Stokes<ScatteringPlane>{std::norm(e_s) + std::norm(e_p), std::norm(e_s) - std::norm(e_p),
                                   2 * (e_s * std::conj(e_p)).real(),
                                   2 * (std::conj(e_s) * e_p).imag()} *
           0.5;
  }
  return out;
}

TEST(IntegratorPolarization, OneMaterialGivesTheCurveOfItsInterface) {
  const Scene scene = scene_of(box_wing(), NormalMode::Flat, {interface_of("paper_au", 20)});
  const Integrator body(scene);
  ASSERT_FALSE(body.is_convex());
  std::size_t bright = 0;
  IntegrationOptions coarse;
  coarse.accuracy = 0.05; // the ratio is exact whatever the points say
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Pose pose = random_pose(i, 1, 179);
    const PoseResult result = body.evaluate(pose, coarse);
    for (std::size_t b = 0; b < 3; ++b) {
      const auto &stokes = result.bands[b].stokes;
      EXPECT_EQ(stokes.u, 0);
      EXPECT_EQ(stokes.v, 0);
      if (!(stokes.i > 0))
        continue;
      ++bright;
      const FresnelFactors f = scene.front[0].fresnel(b, dot(pose.sun, pose.observer));
      EXPECT_NEAR(stokes.q / stokes.i, f.b / f.a, 1e-6) << "pose " << i; // done-when of the job
    }
  }
  EXPECT_GT(bright, 2000u);
}

TEST(IntegratorPolarization, FieldsReflectedAtEachFacetAddUpToTheSame) {
  // Every triangle is a group of its own, gold and aluminium in turn; its share of I is measured
  // and its polarization comes from the fields alone.
  Mesh mesh = box_wing();
  mesh.groups.clear();
  for (Triangle &t : mesh.triangles) {
    t.front = t.back = static_cast<std::uint32_t>(mesh.groups.size());
    mesh.groups.push_back("facet" + std::to_string(mesh.groups.size()));
  }
  const std::vector<Material> metals{interface_of("paper_au", 10), interface_of("paper_al", 30)};
  const Scene scene = scene_of(mesh, NormalMode::Flat, metals);
  const Integrator body(scene);
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Pose pose = random_pose(i);
    const PoseResult result = body.evaluate(pose, {});
    const Vec3<Body> half = normalized(pose.sun + pose.observer);
    for (std::size_t b = 0; b < 3; ++b) {
      Stokes<ScatteringPlane> sum;
      for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
        const auto eta = index_at(metals[g % 2].index, scene.bands[b].wavelength);
        ASSERT_TRUE(eta);
        const Stokes<ScatteringPlane> light = mirror_light(pose, *eta, half);
        const double of_group = result.slot_i[2 * g * 3 + b] + result.slot_i[(2 * g + 1) * 3 + b];
        sum += light * (of_group / light.i);
      }
      const auto &stokes = result.bands[b].stokes;
      EXPECT_NEAR(sum.i, stokes.i, 1e-9 * stokes.i);
      EXPECT_NEAR(sum.q, stokes.q, 1e-9 * stokes.i);
      EXPECT_NEAR(sum.u, 0, 1e-9 * stokes.i);
      EXPECT_NEAR(sum.v, 0, 1e-9 * stokes.i);
    }
  }
}

TEST(IntegratorPolarization, IntensityOfAConvexBodyIsTheSumOfItsMirrors) {
  // The same with the weight of each facet written out: D G / 4 with P = 1 (m = 3000 and no grazing
  // direction: 1 - P < 1e-12 for cosines above 0.3), so that nothing of Surface is used.
  const double m = 3000;
  const Mesh mesh = make_sphere(1, 3000);
  const Material gold = interface_of("paper_au", m);
  const Integrator sphere(scene_of(mesh, NormalMode::Flat, {gold}));
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Pose pose = random_pose(i, 20, 100);
    const Vec3<Body> half = normalized(pose.sun + pose.observer);
    double weight = 0;
    for (const Triangle &t : mesh.triangles) {
      const Vec3<Body> area = area_vector_doubled(mesh, t);
      const Vec3<Body> n = normalized(area);
      if (dot(n, pose.sun) > 0 && dot(n, pose.observer) > 0)
        weight += (m + 2) / (2 * pi) * std::pow(dot(n, half), m) / 4 * norm(area) / 2;
    }
    const auto eta = index_at(gold.index, Wavelength::nm(425));
    ASSERT_TRUE(eta);
    const Stokes<ScatteringPlane> light = mirror_light(pose, *eta, half) * weight;
    const auto stokes = sphere.evaluate(pose, {}).bands[0].stokes;
    EXPECT_NEAR(stokes.i, light.i, 1e-9 * light.i);
    EXPECT_NEAR(stokes.q, light.q, 1e-9 * light.i);
  }
}

} // namespace
} // namespace umov
