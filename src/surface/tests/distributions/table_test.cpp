#include "surface/tests/distributions/distribution_cases.h"

namespace umov {
namespace {

DistributionChoice sampled_beckmann(double alpha, double factor) {
  DistributionChoice out{"table", {}, {}, {}};
  for (double angle = 0; angle < 90; angle += 0.25) {
    const double t = std::tan(angle * degree), c = std::cos(angle * degree);
    out.angle_deg.push_back(angle);
    out.density.push_back(factor * std::exp(-t * t / (alpha * alpha)) / (c * c * c * c));
  }
  return out;
}

TEST(TableOfNormals, IsRescaledAndFollowsWhatItSamples) {
  // A Beckmann surface sampled every quarter of a degree, in arbitrary units.
  const auto table = *make_distribution(sampled_beckmann(.4, 17.3));
  const auto exact = *make_distribution({"beckmann", {{"alpha", .4}}, {}, {}});
  for (double theta = 0; theta < 80; theta += 3.1) {
    const Vec3<Facet> k = tilted(std::cos(theta * degree));
    EXPECT_NEAR(table->density(k), exact->density(k), 1e-4 * exact->density(tilted(1)));
    EXPECT_NEAR(table->masking(k), exact->masking(k), 1e-4);
  }
  EXPECT_NEAR(table->width(), exact->width(), 0.01);
}

TEST(TableOfNormals, IsADistribution) { check_distribution(sampled_beckmann(.3, 1), 1e-4); }

TEST(TableOfNormals, RefusesWhatIsNoTable) {
  EXPECT_FALSE(make_distribution({"table", {}, {0, 10}, {1, 1}}));
  EXPECT_FALSE(make_distribution({"table", {}, {0, 20, 10}, {1, 1, 1}}));
  EXPECT_FALSE(make_distribution({"table", {}, {0, 10, 20}, {0, 0, 0}}));
  EXPECT_FALSE(make_distribution({"table", {}, {5, 10, 20}, {1, 1, 1}}));
  EXPECT_FALSE(make_distribution({"table", {}, {0, 10, 20}, {1, -1, 1}}));
}

} // namespace
} // namespace umov
