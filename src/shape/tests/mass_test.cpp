// Inertia of shells and solids against closed forms.

#include <umov/shape/mass.h>

#include <cmath>
#include <gtest/gtest.h>
#include <umov/shape/primitives.h>

namespace umov {
namespace {

/// A box of half sides (a, b, c) with its centre at `at`, wound outwards.
Mesh box(double a, double b, double c, Vec3<Body> at) {
  Mesh mesh;
  mesh.groups = {"a"};
  for (int k = 0; k < 8; ++k)
    mesh.positions.push_back(at + Vec3<Body>{k & 1 ? a : -a, k & 2 ? b : -b, k & 4 ? c : -c});
  const unsigned faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto &f : faces) {
    mesh.triangles.push_back({{f[0], f[1], f[2]}, {no_index, no_index, no_index}, 0, 0});
    mesh.triangles.push_back({{f[0], f[2], f[3]}, {no_index, no_index, no_index}, 0, 0});
  }
  return mesh;
}

TEST(Mass, SolidBoxInClosedForm) {
  const double a = 1, b = 2, c = 3;
  const auto m = mass_properties(box(a, b, c, {10, -20, 1000}), MassModel::Solid);
  ASSERT_TRUE(m) << m.error().text();
  EXPECT_NEAR(m->amount, 48, 1e-12);
  EXPECT_NEAR(m->center.z, 1000, 1e-10);
  EXPECT_NEAR(m->inertia.xx, (b * b + c * c) / 3, 1e-10);
  EXPECT_NEAR(m->inertia.yy, (a * a + c * c) / 3, 1e-10);
  EXPECT_NEAR(m->inertia.zz, (a * a + b * b) / 3, 1e-10);
  EXPECT_NEAR(m->inertia.xy, 0, 1e-10);
}

TEST(Mass, ShellOfABoxInClosedForm) {
  const double a = 1, b = 2, c = 3;
  const auto m = mass_properties(box(a, b, c, {1, 2, 3}), MassModel::Shell);
  ASSERT_TRUE(m);
  // Faces normal to x, y, z: areas 8bc, 8ac, 8ab for the pairs.
  const double ax = 8 * b * c, ay = 8 * a * c, az = 8 * a * b, area = ax + ay + az;
  const double xx = (ax * a * a + (ay + az) * a * a / 3) / area,
               yy = (ay * b * b + (ax + az) * b * b / 3) / area,
               zz = (az * c * c + (ax + ay) * c * c / 3) / area;
  EXPECT_NEAR(m->amount, area, 1e-12);
  EXPECT_NEAR(m->inertia.xx, yy + zz, 1e-12);
  EXPECT_NEAR(m->inertia.yy, xx + zz, 1e-12);
  EXPECT_NEAR(m->inertia.zz, xx + yy, 1e-12);
}

TEST(Mass, PrincipalAxesOfATurnedBox) {
  Mesh mesh = box(1, 2, 3, {});
  const double t = 0.4;
  for (Vec3<Body> &p : mesh.positions)
    p = {p.x * std::cos(t) - p.y * std::sin(t), p.x * std::sin(t) + p.y * std::cos(t), p.z};
  const auto m = mass_properties(mesh, MassModel::Solid);
  const auto axes = principal_axes(m->inertia);
  ASSERT_TRUE(axes);
  EXPECT_NEAR(axes->moment[0], 5.0 / 3, 1e-12); // about z: 1 + 4
  EXPECT_NEAR(axes->moment[1], 10.0 / 3, 1e-12);
  EXPECT_NEAR(axes->moment[2], 13.0 / 3, 1e-12);
  EXPECT_NEAR(std::abs(axes->axis[0].z), 1, 1e-12);
  EXPECT_NEAR(std::abs(axes->axis[2].x), std::cos(t), 1e-12);
  EXPECT_NEAR(dot(cross(axes->axis[0], axes->axis[1]), axes->axis[2]), 1, 1e-12);
}

TEST(Mass, OfALargeMeshIsStopped) {
  const std::atomic<bool> stop = true;
  for (const MassModel model : {MassModel::Solid, MassModel::Shell}) {
    const auto found = mass_properties(box(1, 2, 3, {}), model, &stop);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, ErrorCode::Interrupted);
  }
}

TEST(Mass, RefusesWhatNoBodyHas) {
  Mesh open = box(1, 1, 1, {});
  open.triangles.pop_back();
  EXPECT_NE(mass_properties(open, MassModel::Solid).error().message.find("not closed"),
            std::string::npos);
  EXPECT_TRUE(mass_properties(open, MassModel::Shell));
  for (const Inertia &bad : {Inertia{1, 1, 3, 0, 0, 0}, Inertia{-1, 1, 1, 0, 0, 0},
                             Inertia{1, 1, 1, 2, 0, 0}, Inertia{NAN, 1, 1, 0, 0, 0}})
    EXPECT_NE(principal_axes(bad).error().message.find("principal moments"), std::string::npos);
  EXPECT_TRUE(principal_axes({1, 1, 2, 0, 0, 0})); // a flat plate
}

} // namespace
} // namespace umov
