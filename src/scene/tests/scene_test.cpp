#include <gtest/gtest.h>
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

} // namespace
} // namespace umov
