#include <gtest/gtest.h>
#include <umov/shape/primitives.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

TEST(MliSheet, FlatOneIsAPlateOfTwoMaterials) {
  const Mesh sheet = make_mli_sheet(1, 0);
  EXPECT_EQ(sheet.groups, (std::vector<std::string>{"front", "back"}));
  EXPECT_EQ(sheet.triangles.size(), 4u);
}

TEST(MliSheet, CrumpledOneShowsBothSidesToSomeDirections) {
  const Mesh sheet = make_mli_sheet(1, 0.3);
  double area = 0;
  std::size_t up = 0, down = 0;
  for (const Triangle &t : sheet.triangles) {
    EXPECT_EQ(t.front, 0u);
    EXPECT_EQ(t.back, 1u);
    const Vec3<Body> twice = area_vector_doubled(sheet, t);
    area += norm(twice) / 2;
    (twice.x > 0 ? up : down) += 1;
  }
  // Folds of slope .3 lengthen: sqrt(1 + 2 x .09) at second order, 1.09; the curl changes little.
  EXPECT_NEAR(area, 1.09, 0.06);
  // Rolled by 2.5 rad: seen along x from one side both faces show.
  EXPECT_GT(up, sheet.triangles.size() / 4);
  EXPECT_GT(down, sheet.triangles.size() / 4);
}

} // namespace
} // namespace umov
