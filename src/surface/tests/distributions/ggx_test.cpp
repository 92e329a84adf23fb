#include "surface/tests/distributions/distribution_cases.h"

namespace umov {
namespace {

TEST(Ggx, MaskingMatchesThePrintedValues) {
  // physics page, section 3: G1 at 45, 75, 85 deg, alpha = .4.
  const auto d = *make_distribution({"ggx", {{"alpha", .4}}, {}, {}});
  EXPECT_NEAR(d->masking(tilted(std::cos(45 * degree))), .962912, 5.1e-7);
  EXPECT_NEAR(d->masking(tilted(std::cos(75 * degree))), .715101, 5.1e-7);
  EXPECT_NEAR(d->masking(tilted(std::cos(85 * degree))), .352106, 5.1e-7);
}

TEST(Ggx, IsADistribution) {
  for (const double alpha : {.02, .1, .4, 1., 2.})
    check_distribution({"ggx", {{"alpha", alpha}}, {}, {}}, 1e-6);
}

} // namespace
} // namespace umov
