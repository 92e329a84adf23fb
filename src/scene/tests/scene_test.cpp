#include <gtest/gtest.h>
#include <limits>
#include <umov/scene/pose.h>
#include <umov/scene/scene.h>
#include <umov/shape/primitives.h>

namespace umov {
namespace {

const std::vector<Band> bands{{"nm:550", Wavelength::nm(550)}};

Material metal() { return builtin_material("paper_al").value(); }

TEST(Scene, WantsOneMaterialPerGroup) {
  Diagnostics diagnostics;
  const auto scene = make_scene(make_cylinder(1, 2, 12), NormalMode::Flat, bands, {metal()},
                                {metal()}, diagnostics);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, ErrorCode::BadInput);
  EXPECT_NE(scene.error().message.find("1 front and 1 back materials for a mesh with 2 groups"),
            std::string::npos);
}

TEST(Scene, WantsABand) {
  Diagnostics diagnostics;
  const auto scene =
      make_scene(make_sphere(1, 100), NormalMode::Flat, {}, {metal()}, {metal()}, diagnostics);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, ErrorCode::BadInput);
}

TEST(Scene, PassesTheErrorOfAMaterialOn) {
  Diagnostics diagnostics;
  Material wrong = metal();
  wrong.distribution = blinn_phong(-1);
  const auto scene =
      make_scene(make_sphere(1, 100), NormalMode::Flat, bands, {wrong}, {metal()}, diagnostics);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, ErrorCode::BadInput);
}

TEST(Scene, SmoothMakesNormalsWhereThereAreNone) {
  Diagnostics diagnostics;
  Mesh mesh = make_sphere(1, 500);
  mesh.normals.clear();
  for (Triangle &t : mesh.triangles)
    t.normal = {no_index, no_index, no_index};
  const auto scene = make_scene(mesh, NormalMode::Smooth, bands, {metal()}, {metal()}, diagnostics);
  ASSERT_TRUE(scene);
  for (const Triangle &t : scene->mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_NE(t.normal[k], no_index);
      // The weights of Max (1999) are exact where vertices lie on a sphere: rounding only.
      EXPECT_LT(norm(scene->mesh.normals[t.normal[k]] - scene->mesh.positions[t.vertex[k]]), 1e-12);
    }
}

TEST(Pose, DirectionsOfAnyLengthAndNoneOfNothing) {
  const double inf = std::numeric_limits<double>::infinity();
  const Vec3<Body> expected{2.0 / 3, -1.0 / 3, 2.0 / 3};
  for (const double scale : {1e-320, 1e-200, 1.0, 1e150, 8e307}) {
    const auto found = direction_along(Vec3<Body>{scale, -scale / 2, scale});
    ASSERT_TRUE(found);
    // 1e-320 has three digits.
    EXPECT_LT(norm(*found - expected), scale < 1e-300 ? 1e-3 : 1e-15) << scale;
  }
  const Vec3<Body> unit = normalized(Vec3<Body>{0.1, 0.2, 0.3});
  EXPECT_EQ(*direction_along(unit), unit); // the poses of a table come back from it
  for (const Vec3<Body> &none : {Vec3<Body>{}, {inf, 0, 0}, {1, -inf, inf}, {0, inf - inf, 1}})
    EXPECT_FALSE(direction_along(none));
}

} // namespace
} // namespace umov
