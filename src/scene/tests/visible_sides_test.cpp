#include <algorithm>
#include <gtest/gtest.h>
#include <umov/scene/scene.h>
#include <umov/shape/primitives.h>

namespace umov {
namespace {

TEST(VisibleSides, InsideOfAClosedBodyIsHidden) {
  for (const VisibleSides sides : visible_sides(make_cylinder(1, 2, 16))) {
    EXPECT_TRUE(sides.front);
    EXPECT_FALSE(sides.back);
  }
}

TEST(VisibleSides, ClosedBodyTurnedInsideOutShowsItsBacks) {
  Mesh mesh = make_sphere(1, 200);
  for (Triangle &t : mesh.triangles)
    std::swap(t.vertex[1], t.vertex[2]);
  for (const VisibleSides sides : visible_sides(mesh)) {
    EXPECT_FALSE(sides.front);
    EXPECT_TRUE(sides.back);
  }
}

TEST(VisibleSides, OneMissingFaceOpensTheWholePart) {
  Mesh mesh = make_sphere(1, 200);
  mesh.triangles.pop_back();
  for (const VisibleSides sides : visible_sides(mesh))
    EXPECT_TRUE(sides.front && sides.back);
}

TEST(VisibleSides, OneFlippedFaceOpensTheWholePart) {
  Mesh mesh = make_sphere(1, 200);
  std::swap(mesh.triangles[7].vertex[1], mesh.triangles[7].vertex[2]);
  for (const VisibleSides sides : visible_sides(mesh))
    EXPECT_TRUE(sides.front && sides.back);
}

TEST(VisibleSides, SheetShowsBoth) {
  for (const VisibleSides sides : visible_sides(make_plate(1, 1, false)))
    EXPECT_TRUE(sides.front && sides.back);
}

} // namespace
} // namespace umov
