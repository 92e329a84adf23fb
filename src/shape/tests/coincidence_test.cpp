#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <umov/core/quantity.h>
#include <umov/shape/primitives.h>
#include <umov/shape/topology.h>
#include <umov/shape/triangulate.h>

namespace umov {
namespace {

using Outline = std::vector<Vec3<Body>>;

/// A face as a file gives it: cut as the reader cuts it.
void add_face(Mesh &mesh, const Outline &corners, std::uint32_t group) {
  const auto shift = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
  for (const auto &t : triangulate(corners).triangles)
    mesh.triangles.push_back(
        {{t[0] + shift, t[1] + shift, t[2] + shift}, {no_index, no_index, no_index}, group, group});
}

Outline turned(Outline corners, std::size_t by) {
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(by), corners.end());
  return corners;
}

Outline backwards(Outline corners) {
  std::reverse(corners.begin(), corners.end());
  return corners;
}

Outline polygon(std::size_t count) {
  Outline out;
  for (std::size_t k = 0; k < count; ++k) {
    const double a = 2 * pi * static_cast<double>(k) / static_cast<double>(count);
    out.push_back({std::cos(a), std::sin(a), 0.3 * std::cos(a)}); // in a tilted plane
  }
  return out;
}

Mesh with_groups(std::size_t count) {
  Mesh mesh;
  for (std::size_t g = 0; g < count; ++g)
    mesh.groups.push_back("g" + std::to_string(g));
  return mesh;
}

double area_of(const Mesh &mesh) {
  double sum = 0;
  for (const Triangle &t : mesh.triangles)
    sum += norm(area_vector_doubled(mesh, t)) / 2;
  return sum;
}

bool says(const Diagnostics &diagnostics, const std::string &words) {
  return std::any_of(diagnostics.warnings().begin(), diagnostics.warnings().end(),
                     [&](const Warning &w) { return w.message.find(words) != std::string::npos; });
}

void expect_one_sheet(const Mesh &mesh, const Outline &outline, std::uint32_t front,
                      std::uint32_t back, const std::string &what) {
  Mesh single = with_groups(mesh.groups.size());
  add_face(single, outline, front);
  Diagnostics diagnostics;
  const auto cleaned = clean_mesh(mesh, diagnostics);
  ASSERT_TRUE(cleaned) << what;
  EXPECT_NEAR(area_of(*cleaned), area_of(single), 1e-5 * area_of(single)) << what;
  EXPECT_FALSE(inspect(*cleaned).is_closed) << what;
  EXPECT_FALSE(says(diagnostics, "lie upon each other")) << what;
  for (const Triangle &t : cleaned->triangles) {
    EXPECT_EQ(t.front, front) << what;
    EXPECT_EQ(t.back, back) << what;
  }
}

// `f 1 2 3 4` and `f 4 3 2 1` are fans from corners 1 and 4: other diagonals.
TEST(Coincidence, PolygonsCutInAnyWayBecomeOneSheet) {
  for (const std::size_t corners : {3u, 4u, 5u, 6u, 9u})
    for (std::size_t turn = 0; turn < corners; ++turn) {
      const Outline face = polygon(corners);
      Mesh mesh = with_groups(2);
      add_face(mesh, face, 0);
      add_face(mesh, turned(backwards(face), turn), 1);
      expect_one_sheet(mesh, face, 0, 1,
                       std::to_string(corners) + " corners, turned by " + std::to_string(turn));
      EXPECT_EQ(inspect(mesh).opposite_pairs, corners - 2);
    }
}

TEST(Coincidence, CornersWithinTheWeldingDistanceAreOne) {
  const Outline face = polygon(6);
  Mesh mesh = with_groups(2);
  add_face(mesh, face, 0);
  Outline back = turned(backwards(face), 2);
  double at = 0;
  for (Vec3<Body> &p : back) { // by less than 1e-6 of 2 m
    at += 1;
    p += 5e-7 * Vec3<Body>{std::sin(3 * at), std::cos(5 * at), std::sin(7 * at)};
  }
  add_face(mesh, back, 1);
  expect_one_sheet(mesh, face, 0, 1, "perturbed");
}

TEST(Coincidence, ConcaveFacesAndFacesOfManyPieces) {
  // An L, the one side with ears cut from another corner than the other side's.
  const Outline el{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  for (std::size_t turn = 0; turn < el.size(); ++turn) {
    Mesh mesh = with_groups(2);
    add_face(mesh, el, 0);
    add_face(mesh, turned(backwards(el), turn), 1);
    expect_one_sheet(mesh, el, 0, 1, "L turned by " + std::to_string(turn));
  }
  // One square on two halves of two materials: the halves stay, with the square's as their back.
  const Outline square{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  Mesh mesh = with_groups(3);
  add_face(mesh, square, 0);
  add_face(mesh, {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}, 1);
  add_face(mesh, {{1, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 0, 0}}, 2);
  Diagnostics diagnostics;
  const auto cleaned = clean_mesh(mesh, diagnostics);
  ASSERT_TRUE(cleaned);
  EXPECT_NEAR(area_of(*cleaned), 2, 1e-12);
  EXPECT_FALSE(says(diagnostics, "lie upon each other"));
  for (const Triangle &t : cleaned->triangles) {
    EXPECT_NE(t.front, 0u);
    EXPECT_EQ(t.back, 0u);
  }
}

// A dish of bent quads: other diagonals give other facets, which only nearly coincide.
TEST(Coincidence, BentPolygonsOfOneOutlineAreOneSheet) {
  const Outline bent{{0, 0, 0}, {1, 0, 4e-4}, {1, 1, 0}, {0, 1, 4e-4}};
  Mesh mesh = with_groups(2);
  add_face(mesh, bent, 0);
  add_face(mesh, backwards(bent), 1);
  expect_one_sheet(mesh, bent, 0, 1, "bent");
  // A sliver of a wedge of the same thickness has another outline and stays what it is.
  Mesh wedge = with_groups(1);
  const Vec3<Body> edge[2] = {{0, 0, 0}, {0, 1, 0}}, low[2] = {{1, 0, 0}, {1, 1, 0}},
                   high[2] = {{1, 0, 8e-4}, {1, 1, 8e-4}};
  add_face(wedge, {edge[0], high[0], high[1], edge[1]}, 0);
  add_face(wedge, {edge[0], edge[1], low[1], low[0]}, 0);
  add_face(wedge, {low[0], low[1], high[1], high[0]}, 0);
  add_face(wedge, {edge[0], low[0], high[0]}, 0);
  add_face(wedge, {edge[1], high[1], low[1]}, 0);
  Diagnostics diagnostics;
  const auto cleaned = clean_mesh(wedge, diagnostics);
  ASSERT_TRUE(cleaned);
  EXPECT_EQ(cleaned->triangles.size(), wedge.triangles.size());
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_TRUE(inspect(*cleaned).is_closed);
}

TEST(Coincidence, RepeatedPolygonsAreDroppedWithACount) {
  const Outline face = polygon(6);
  Mesh mesh = with_groups(2);
  add_face(mesh, face, 0);
  add_face(mesh, turned(face, 1), 0);
  add_face(mesh, turned(backwards(face), 3), 1);
  add_face(mesh, turned(face, 2), 1);
  expect_one_sheet(mesh, face, 0, 1, "four layers");
  EXPECT_EQ(inspect(mesh).duplicate, 8u);
  EXPECT_EQ(inspect(mesh).opposite_pairs, 4u);
  Diagnostics diagnostics;
  ASSERT_TRUE(clean_mesh(mesh, diagnostics));
  EXPECT_TRUE(says(diagnostics, "8 triangles that repeat"));
  EXPECT_TRUE(says(diagnostics, "4 dropped triangles were of another material"));
}

TEST(Coincidence, OverlapsThatRemainAreNamedWithMaterialsAndArea) {
  const Outline square{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  const Outline part{{1, 0.5, 0}, {3, 0.5, 0}, {3, 1.5, 0}, {1, 1.5, 0}}; // 0.5 m2 in common
  for (const bool is_opposite : {false, true}) {
    Mesh mesh = with_groups(2);
    add_face(mesh, square, 0);
    add_face(mesh, is_opposite ? backwards(part) : part, 1);
    Diagnostics diagnostics;
    const auto cleaned = clean_mesh(mesh, diagnostics);
    ASSERT_TRUE(cleaned);
    EXPECT_EQ(cleaned->triangles.size(), 4u);
    EXPECT_TRUE(
        says(diagnostics, "\"g0\" and \"g1\" lie upon each other in one plane over 0.5 m2"));
    EXPECT_TRUE(says(diagnostics, is_opposite ? "opposite ways" : "the same way"));
  }
  // Side by side in one plane, or one above the other, is no overlap.
  Mesh mesh = with_groups(2);
  add_face(mesh, square, 0);
  add_face(mesh, {{2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}}, 1);
  add_face(mesh, {{0, 0, 1e-4}, {2, 0, 1e-4}, {2, 1, 1e-4}, {0, 1, 1e-4}}, 1);
  Diagnostics diagnostics;
  ASSERT_TRUE(clean_mesh(mesh, diagnostics));
  EXPECT_TRUE(diagnostics.empty());
}

// Solids that stand on each other hide the faces between them: nothing to tell of.
TEST(Coincidence, SolidsInContactAreLeftAlone) {
  Mesh mesh = make_cylinder(1, 2, 24);
  const Mesh small = make_cylinder(0.5, 1, 24);
  const auto shift = static_cast<std::uint32_t>(mesh.positions.size());
  const double top = inspect(mesh).upper.z - inspect(small).lower.z;
  for (const Vec3<Body> &p : small.positions)
    mesh.positions.push_back({p.x + 0.1, p.y, p.z + top});
  for (Triangle t : small.triangles) {
    for (std::uint32_t &v : t.vertex)
      v += shift;
    mesh.triangles.push_back(t);
  }
  Diagnostics diagnostics;
  const auto cleaned = clean_mesh(mesh, diagnostics);
  ASSERT_TRUE(cleaned);
  EXPECT_EQ(cleaned->triangles.size(), mesh.triangles.size());
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_EQ(inspect(*cleaned).parts, 2u);
}

TEST(Coincidence, ShippedShapesHaveNone) {
  for (const Mesh &mesh : {make_hst(), make_agena(), make_sphere(1, 5000), make_cylinder(1, 2, 512),
                           make_box_wing({}), make_chamfered_cube(1, 0.1)}) {
    Diagnostics diagnostics;
    const auto cleaned = clean_mesh(mesh, diagnostics);
    ASSERT_TRUE(cleaned);
    EXPECT_EQ(cleaned->triangles.size(), mesh.triangles.size());
    for (const Warning &w : diagnostics.warnings())
      ADD_FAILURE() << mesh.groups[0] << ": " << w.message;
  }
}

} // namespace
} // namespace umov
