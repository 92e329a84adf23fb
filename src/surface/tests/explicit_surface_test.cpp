#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/quantity.h>
#include <umov/surface/explicit_surface.h>

namespace umov {
namespace {

TEST(ExplicitSurface, AgreesWithThePublishedFractionsScatteredOnce) {
  // physics page, section 4, rows a (24 surfaces, 8 cells a correlation length): E1 explicit at
  // slope .3: .9868 at 0 and .8887 at 60 deg; model (ashikhmin) .9825, .8844. Two surfaces here:
  // their scatter is .003.
  const auto normals =
      *make_distribution({"beckmann", {{"alpha", std::sqrt(2.) * .3}}, {}, {}, {}});
  const struct { double theta, traced, model; } rows[] = {{0, .9868, .9825}, {60, .8887, .8844}};
  for (const auto &row : rows) {
    const double theta = row.theta * pi / 180;
    double once = 0;
    for (const std::uint64_t seed : {1u, 2u}) {
      const auto field = make_height_field({.cells = 256, .slope = .3, .seed = seed});
      once += trace_height_field(*field, theta, 60'000, seed, 2).once / 2;
    }
    EXPECT_NEAR(once, row.traced, .006) << row.theta;
    const SingleScatter model = model_scatter(*normals, Shadowing::Ashikhmin, theta);
    EXPECT_NEAR(model.once, row.model, 1.0e-4) << row.theta;
  }
}

TEST(ExplicitSurface, DoesNotDependOnThreads) {
  const auto field = make_height_field({.cells = 64, .slope = .5, .seed = 4});
  const auto one = trace_height_field(*field, 0.9, 20'000, 5, 1);
  const auto two = trace_height_field(*field, 0.9, 20'000, 5, 2);
  EXPECT_EQ(one.flux, two.flux);
}

} // namespace
} // namespace umov
