#include "core/tests/anchors.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/quantity.h>
#include <umov/surface/explicit_surface.h>

namespace umov {
namespace {

TEST(ExplicitSurface, AgreesWithAnotherTracerAndWithTheModel) {
  // Slope .3 per axis. Rays that march through four other fields (8 cells a correlation length)
  // leave .002; the scatter of the two surfaces here is .003. The model's light scattered once is
  // the furnace albedo of the same Beckmann lobe.
  const auto normals =
      *make_distribution({"beckmann", {{"alpha", std::sqrt(2.) * .3}}, {}, {}, {}});
  for (const AnchorRow &row : Anchors("explicit")) {
    const double theta = row["theta_deg"] * pi / 180;
    double once = 0;
    for (const std::uint64_t seed : {1u, 2u}) {
      const auto field = make_height_field({.cells = 256, .slope = .3, .seed = seed});
      once += trace_height_field(*field, theta, 60'000, seed, 2).once / 2;
    }
    EXPECT_NEAR(once, row["once"], .006) << row["theta_deg"];
    const SingleScatter model = model_scatter(*normals, Shadowing::Ashikhmin, theta);
    EXPECT_NEAR(model.once, row["model"], 1.0e-4) << row["theta_deg"];
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
