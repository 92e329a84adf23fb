#include "paper/plane_fit.h"
#include "paper/statistics.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/random.h>
#include <umov/paper/paper.h>

namespace umov {
namespace {

TEST(PlaneFit, FindsThePlaneThatPointsWereMadeOn) {
  std::vector<QPoint> points;
  for (std::size_t i = 0; i < 500; ++i) {
    const auto u = uniform4(1, 1, i);
    points.push_back({u[0], u[1], 0.5 - 0.2 * u[0] + 0.3 * u[1]}); // .2 x - .3 y + z = .5
  }
  const PlaneFit plane = fit_plane(points);
  const double length = std::sqrt(.04 + .09 + 1);
  EXPECT_NEAR(std::abs(plane.normal[2]), 1 / length, 1e-12);
  EXPECT_NEAR(std::abs(plane.offset), .5 / length, 1e-12);
  EXPECT_LT(plane.thickness(), 1e-7);
  EXPECT_NEAR(std::abs(plane.distance({0, 0, 0})), .5 / length, 1e-12);
}

TEST(PlaneFit, ConfusionOfCloudsApartAndAlike) {
  std::vector<QPoint> a, b, c;
  for (std::size_t i = 0; i < 400; ++i) {
    const auto u = uniform4(2, 1, i), v = uniform4(2, 2, i);
    a.push_back({u[0], u[1], u[2]});
    b.push_back({v[0], v[1], v[2]});
    c.push_back({v[0] + 5, v[1], v[2]});
  }
  EXPECT_EQ(nearest_neighbour_confusion(a, c), 0);
  // Two draws from one law: a half, with a standard deviation of about .5/sqrt(800) = .018.
  EXPECT_NEAR(nearest_neighbour_confusion(a, b), 0.5, 0.09);
}

TEST(PlaneFit, SingularValuesShowTheRank) {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < 50; ++i) {
    const auto u = uniform4(3, 1, i);
    rows.push_back({u[0], u[1], u[0] + u[1], u[0] - u[1]});
  }
  const auto values = relative_singular_values(rows);
  EXPECT_EQ(values[0], 1);
  EXPECT_GT(values[1], 0.05);
  EXPECT_LT(values[2], 1e-14);
}

TEST(Statistics, QuantilesAndRanks) {
  EXPECT_EQ(quantile({5, 1, 4, 2, 3}, 0.5), 3);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  EXPECT_NEAR(rank_correlation({1, 2, 3, 4}, {1, 8, 27, 64}), 1, 1e-12);
  EXPECT_NEAR(rank_correlation({1, 2, 3, 4}, {9, 7, 3, -1}), -1, 1e-12);
  // Kendall & Gibbons 1990: 1 - 6 sum d2/(n3 - n), here d = (1, -1, 1, -1): 1 - 24/60.
  EXPECT_NEAR(rank_correlation({1, 2, 3, 4}, {2, 1, 4, 3}), 0.6, 1e-12);
}

TEST(Paper, AnUnknownFigureHasANearestName) {
  const auto made = Paper({}).make("claim_rol");
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::Usage);
  EXPECT_NE(made.error().message.find("mean \"claim_roll\""), std::string::npos);
}

} // namespace
} // namespace umov
