// The benchmark's satellite is what its figures say.

#include <gtest/gtest.h>
#include <umov/shape/primitives.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

TEST(BoxWing, HasTheFacetsAskedFor) {
  for (const std::size_t facets : {1'000u, 10'000u, 100'000u}) {
    const Mesh mesh = make_box_wing({facets, 0});
    EXPECT_GE(mesh.triangles.size(), facets);
    EXPECT_LT(static_cast<double>(mesh.triangles.size()), 1.1 * static_cast<double>(facets));
  }
}

TEST(BoxWing, HasFourMaterialsAndFortyPercentOfItsAreaCurved) {
  const Mesh mesh = make_box_wing();
  EXPECT_EQ(mesh.groups.size(), 4u);
  double all = 0, curved = 0;
  for (const Triangle &t : mesh.triangles) {
    const double area = 0.5 * norm(area_vector_doubled(mesh, t));
    all += area;
    const Vec3<Body> a = mesh.normals[t.normal[0]];
    if (norm(mesh.normals[t.normal[1]] - a) + norm(mesh.normals[t.normal[2]] - a) > 1e-6)
      curved += area;
  }
  EXPECT_GE(curved / all, 0.40);
}

TEST(BoxWing, IsClosedAndWoundOutward) {
  for (const double crumple : {0.0, 0.01}) {
    const Mesh mesh = make_box_wing({3'000, crumple});
    Vec3<Body> sum{}; // of area vectors: zero for closed surfaces
    double volume = 0, size = 0;
    for (const Triangle &t : mesh.triangles) {
      const Vec3<Body> doubled = area_vector_doubled(mesh, t);
      sum += doubled;
      volume += dot(mesh.positions[t.vertex[0]], doubled) / 6;
      size += norm(doubled);
      // Each face looks where its vertex normals do; foil has those of the face it covers.
      EXPECT_GT(dot(doubled, mesh.normals[t.normal[0]]), 0);
    }
    EXPECT_LT(norm(sum), 1e-9 * size);
    EXPECT_GT(volume, 2);
  }
}

} // namespace
} // namespace umov
