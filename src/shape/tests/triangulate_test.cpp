#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/quantity.h>
#include <umov/shape/triangulate.h>

namespace umov {
namespace {

using Corners = std::vector<Vec3<Body>>;

double signed_area(const Corners &c, const Triangulation &t) { // along z
  double area = 0;
  for (const auto &[i, j, k] : t.triangles)
    area += cross(c[j] - c[i], c[k] - c[i]).z / 2;
  return area;
}

TEST(Triangulate, ConvexAndConcaveOutlinesKeepTheirArea) {
  const struct {
    Corners corners;
    double area;
  } rows[] = {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 1},
              {{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, 3}, // an L
              {{{0, 0, 0}, {2, 0, 0}, {1, 0.2, 0}, {1, 2, 0}}, 1.1},
              {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, 2}}; // a corner on an edge
  for (const auto &row : rows) {
    const Triangulation t = triangulate(row.corners);
    EXPECT_EQ(t.triangles.size(), row.corners.size() - 2);
    EXPECT_TRUE(t.is_simple);
    Vec3<Body> shoelace{};
    for (std::size_t i = 0; i < row.corners.size(); ++i)
      shoelace += cross(row.corners[i], row.corners[(i + 1) % row.corners.size()]) / 2;
    EXPECT_NEAR(signed_area(row.corners, t), shoelace.z, 1e-14);
  }
}

TEST(Triangulate, StarOf10000CornersIsFast) {
  Corners star;
  for (int i = 0; i < 10000; ++i) {
    const double r = i % 2 == 0 ? 1 : 0.7, phi = 2 * pi * i / 10000;
    star.push_back({r * std::cos(phi), r * std::sin(phi), 0});
  }
  const Triangulation t = triangulate(star);
  EXPECT_EQ(t.triangles.size(), star.size() - 2);
  EXPECT_TRUE(t.is_simple);
  EXPECT_NEAR(signed_area(star, t), 10000 * 0.5 * 0.7 * std::sin(2 * pi / 10000), 1e-9);
}

TEST(Triangulate, LargeDiscsAreCutIntoTrianglesThatLieApart) {
  Corners disc;
  for (int i = 0; i < 1000; ++i)
    disc.push_back({std::cos(2 * pi * i / 1000), std::sin(2 * pi * i / 1000), 0});
  const Triangulation t = triangulate(disc);
  ASSERT_EQ(t.triangles.size(), disc.size() - 2);
  // The area of a regular polygon, n / 2 sin(2 pi / n); the sum rounds some 1000 times.
  EXPECT_NEAR(signed_area(disc, t), 500 * std::sin(2 * pi / 1000), 1e-12);
  double boxes = 0; // a fan has some 500
  for (const auto &[i, j, k] : t.triangles) {
    const auto [left, right] = std::minmax({disc[i].x, disc[j].x, disc[k].x});
    const auto [low, high] = std::minmax({disc[i].y, disc[j].y, disc[k].y});
    boxes += (right - left) * (high - low);
  }
  EXPECT_LT(boxes, 20);
}

TEST(Triangulate, TellsOfCrossingAndBentOutlines) {
  Corners pentagram;
  for (int i = 0; i < 5; ++i)
    pentagram.push_back({std::cos(4 * pi * i / 5), std::sin(4 * pi * i / 5), 0});
  EXPECT_FALSE(triangulate(pentagram).is_simple);
  EXPECT_EQ(triangulate(pentagram).triangles.size(), 3u);
  EXPECT_FALSE(triangulate(Corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.3}, {0, 1, 0}}).is_planar);
}

TEST(Triangulate, AHoleWithABridgeIsFilledAround) {
  // A square of 4 with a hole of 1, joined by a cut: area 15.
  const Corners keyhole{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                        {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}};
  const Triangulation t = triangulate(keyhole);
  EXPECT_NEAR(signed_area(keyhole, t), 15, 1e-12);
}

} // namespace
} // namespace umov
