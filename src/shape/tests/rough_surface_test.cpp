#include <cmath>
#include <gtest/gtest.h>
#include <umov/shape/rough_surface.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

TEST(RoughSurface, HasTheSlopeAndCorrelationAskedFor) {
  const auto field =
      make_height_field({.cells = 256, .slope = 0.4, .correlation_cells = 8, .seed = 3});
  ASSERT_TRUE(field);
  double slopes = 0, variance = 0, covariance = 0, mean = 0;
  const std::size_t n = field->cells;
  for (std::size_t y = 0; y < n; ++y)
    for (std::size_t x = 0; x < n; ++x) {
      const double h = field->at(x, y);
      slopes += std::pow(field->at(x + 1, y) - h, 2);
      mean += h;
      variance += h * h;
      covariance += h * field->at(x + 8, y);
    }
  const double count = static_cast<double>(n * n);
  EXPECT_NEAR(mean / count, 0, 1e-12);
  // Both axes together have it exactly; one of them within the noise of 256/8 squared patches.
  EXPECT_NEAR(std::sqrt(slopes / count), 0.4, 0.01);
  EXPECT_NEAR(covariance / variance, std::exp(-1), 0.06); // exp(-r2/l2) at r = l; 1,000 patches
}

TEST(RoughSurface, IsASheetOfTheFacetsPromised) {
  const auto field = make_height_field({.cells = 256, .slope = 0.3});
  const Mesh mesh = mesh_of(*field);
  EXPECT_EQ(mesh.triangles.size(), 131'072u);
  EXPECT_EQ(inspect(mesh).inconsistent_edges, 0u);
  EXPECT_EQ(inspect(mesh).open_edges, 4u * 256);
}

TEST(RoughSurface, FractalsHaveFinerScales) {
  const auto plain = make_height_field({.cells = 128, .slope = 0.3, .correlation_cells = 16});
  const auto fractal =
      make_height_field({.cells = 128, .slope = 0.3, .correlation_cells = 16, .hurst = 0.8});
  const auto height = [](const HeightField &f) {
    double sum = 0;
    for (const double h : f.height_m)
      sum += h * h;
    return std::sqrt(sum / static_cast<double>(f.height_m.size()));
  };
  EXPECT_LT(height(*fractal), 0.8 * height(*plain)); // the same slope with less height
}

TEST(RoughSurface, RefusesImpossibleNumbers) {
  EXPECT_FALSE(make_height_field({.cells = 8}));
  EXPECT_FALSE(make_height_field({.cells = 64, .correlation_cells = 9}));
  EXPECT_FALSE(make_height_field({.slope = -1}));
  EXPECT_FALSE(make_height_field({.hurst = 2}));
}

} // namespace
} // namespace umov
