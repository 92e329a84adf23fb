#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <umov/core/quantity.h>
#include <umov/shape/primitives.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

Mesh joined(Mesh a, const Mesh &b) {
  const auto shift = static_cast<std::uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (Triangle t : b.triangles) {
    for (std::uint32_t &v : t.vertex)
      v += shift;
    t.normal = {no_index, no_index, no_index};
    a.triangles.push_back(t);
  }
  return a;
}

void flip(Mesh &mesh) {
  for (Triangle &t : mesh.triangles)
    std::swap(t.vertex[1], t.vertex[2]);
}

TEST(Topology, ACubeIsClosedOutwardAndConvex) {
  // Chamfered cube: faces 6 s^2, edges 12 s c sqrt(2), corners 8 (sqrt(3)/2) c^2, s = .8, c = .1.
  const MeshReport r = inspect(make_chamfered_cube(1, 0.1));
  EXPECT_TRUE(r.is_closed && r.is_convex);
  EXPECT_EQ(r.parts, 1u);
  EXPECT_EQ(r.inward_parts, 0u);
  EXPECT_NEAR(r.area_m2, 6 * 0.64 + 12 * 0.08 * std::sqrt(2) + 4 * std::sqrt(3) * 0.01, 1e-12);
  EXPECT_NEAR(r.upper.x - r.lower.x, 1, 1e-15);
}

TEST(Topology, OpenFlippedAndConcaveMeshesAreToldApart) {
  Mesh open = make_chamfered_cube(1, 0.1);
  open.triangles.resize(open.triangles.size() - 2);
  EXPECT_FALSE(inspect(open).is_closed);
  EXPECT_GT(inspect(open).open_edges, 0u);

  Mesh inward = make_chamfered_cube(1, 0.1);
  flip(inward);
  EXPECT_EQ(inspect(inward).inward_parts, 1u);
  EXPECT_FALSE(is_proven_convex(inward));

  Mesh far = make_chamfered_cube(1, 0.1);
  for (Vec3<Body> &p : far.positions)
    p.x += 3;
  const MeshReport two = inspect(joined(make_chamfered_cube(1, 0.1), far));
  EXPECT_EQ(two.parts, 2u);
  EXPECT_TRUE(two.is_closed);
  EXPECT_FALSE(two.is_convex);

  EXPECT_FALSE(inspect(make_agena()).is_convex); // one closed part with a waist
  EXPECT_TRUE(is_proven_convex(make_plate(2, 1, false)));
  EXPECT_TRUE(is_proven_convex(make_sphere(1, 5000)));
  EXPECT_TRUE(is_proven_convex(make_cylinder(1, 2, 48)));
}

TEST(Topology, CleaningCountsMergesAndRefuses) {
  Mesh mesh = make_plate(1, 1, true); // two pairs of opposite faces
  mesh.triangles.push_back(mesh.triangles[0]);
  mesh.triangles.push_back({{0, 1, 1}, {no_index, no_index, no_index}, 0, 0});
  const MeshReport r = inspect(mesh);
  EXPECT_EQ(r.opposite_pairs, 2u);
  EXPECT_EQ(r.duplicate, 1u);
  EXPECT_EQ(r.degenerate, 1u);
  Diagnostics diagnostics;
  const auto cleaned = clean_mesh(mesh, diagnostics);
  ASSERT_TRUE(cleaned);
  EXPECT_EQ(cleaned->triangles.size(), 2u);
  EXPECT_EQ(cleaned->triangles[0].front, 0u);
  EXPECT_EQ(cleaned->triangles[0].back, 1u);
  EXPECT_EQ(diagnostics.warnings().size(), 3u);

  Mesh bad = mesh;
  bad.positions[0].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(clean_mesh(bad, diagnostics));
  bad = mesh;
  bad.triangles[0].vertex[0] = 1000;
  EXPECT_FALSE(clean_mesh(bad, diagnostics));
  bad = mesh;
  bad.triangles.clear();
  EXPECT_FALSE(clean_mesh(bad, diagnostics));
}

TEST(Topology, FarVerticesThatNoFaceUsesDoNoHarm) {
  Mesh mesh = make_chamfered_cube(1, 0.1);
  mesh.positions.push_back({1e300, -1e300, 1e300});
  EXPECT_TRUE(inspect(mesh).is_convex);
  Mesh point;
  point.positions = {{1e6, 2e6, 3e6}};
  point.groups = {"a"};
  point.triangles.push_back({});
  Diagnostics diagnostics;
  EXPECT_FALSE(clean_mesh(point, diagnostics));
}

TEST(Topology, CreasesStaySharpAndCurvesBecomeRound) {
  Mesh tube = make_cylinder(1, 2, 24); // 15 deg between sides, 90 deg to the caps
  for (Triangle &t : tube.triangles)
    t.normal = {no_index, no_index, no_index};
  tube.normals.clear();
  const Mesh smooth = with_vertex_normals(tube, 35 * pi / 180);
  for (const Triangle &t : smooth.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3<Body> p = smooth.positions[t.vertex[k]], n = smooth.normals[t.normal[k]];
      if (smooth.groups[t.front] == "caps") {
        EXPECT_NEAR(std::abs(n.z), 1, 1e-12);
      } else { // radial within a third of a side: the neighbours' areas differ from corner to
               // corner
        EXPECT_GT(dot(n, normalized(Vec3<Body>{p.x, p.y, 0})), std::cos(6 * pi / 180));
      }
    }
}

TEST(Topology, SilhouetteOfConvexBodies) {
  EXPECT_NEAR(silhouette_upper_bound(make_sphere(1, 20000), {0, 0, 1}), pi, 1e-3 * pi);
  EXPECT_NEAR(silhouette_upper_bound(make_plate(2, 3, false), {0, 0, 1}), 6, 1e-12);
}

TEST(Shapes, AreClosedOutwardAndCleanWithUnitNormals) {
  for (const Mesh &mesh :
       {make_sphere(1, 100), make_cylinder(1, 2, 12), make_ellipsoid(0.25, 0.25, 1, 5000),
        make_chamfered_cube(1, 0.1), make_hst(), make_agena()}) {
    const MeshReport r = inspect(mesh);
    EXPECT_TRUE(r.is_closed) << mesh.groups[0];
    EXPECT_EQ(r.inward_parts + r.inconsistent_edges + r.degenerate + r.duplicate + r.opposite_pairs,
              0u);
    for (const Vec3<Body> &n : mesh.normals)
      EXPECT_NEAR(norm(n), 1, 1e-14);
  }
}

TEST(Shapes, ConvergeToTheirClosedForms) {
  // Sphere: area 4 pi with second order in the edge length; prolate spheroid 0.25, 0.25, 1: volume
  // pi/12.
  const double coarse = 4 * pi - inspect(make_sphere(1, 1280)).area_m2;
  const double fine = 4 * pi - inspect(make_sphere(1, 20480)).area_m2;
  EXPECT_NEAR(coarse / fine, 16, 1.5); // facets are not all of one shape
  EXPECT_NEAR(inspect(make_ellipsoid(0.25, 0.25, 1, 20000)).volume_m3, pi / 12, 2e-3 * pi / 12);
  EXPECT_GE(make_ellipsoid(0.25, 0.25, 1, 5000).triangles.size(), 5000u);
  // A prism on a regular polygon: (n/2) sin(2 pi/n) times the height.
  EXPECT_NEAR(inspect(make_cylinder(1, 2, 2000)).volume_m3, 2000 * std::sin(2 * pi / 2000), 1e-10);
}

TEST(Shapes, SpheresOfAnySizeAreConvex) {
  for (const std::size_t facets :
       {8u, 9u, 20u, 33u, 50u, 100u, 137u, 300u, 777u, 1000u, 2000u, 5000u, 10000u, 40000u}) {
    const MeshReport r = inspect(make_sphere(1, facets));
    EXPECT_TRUE(r.is_convex) << facets;
    EXPECT_GE(r.triangles, facets);
    EXPECT_LE(static_cast<double>(r.triangles), 1.6 * static_cast<double>(facets) + 8) << facets;
  }
}

TEST(Shapes, HstHasItsPublishedSizes) {
  const MeshReport r = inspect(make_hst());
  const Mesh mesh = make_hst();
  EXPECT_EQ(mesh.groups.size(), 11u);
  const auto front = std::find(mesh.groups.begin(), mesh.groups.end(), "array_front");
  ASSERT_NE(front, mesh.groups.end()); // 2 wings of 2.5 m x 12.1 m
  EXPECT_NEAR(r.group_area_m2[static_cast<std::size_t>(front - mesh.groups.begin())],
              2 * 2.5 * 12.1, 1e-9);
  HstOptions closed;
  closed.door_angle_rad = 0;
  const MeshReport shut = inspect(make_hst(closed));
  EXPECT_NEAR(shut.upper.z - shut.lower.z, 13.2, 0.1); // the door lies on the rim
}

} // namespace
} // namespace umov
