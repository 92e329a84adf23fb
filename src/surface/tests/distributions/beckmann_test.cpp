#include "surface/tests/distributions/distribution_cases.h"

namespace umov {
namespace {

TEST(Beckmann, MaskingMatchesThePrintedValues) {
  // physics page, section 3: G1 at 45, 75, 85 deg, alpha = .4.
  const auto d = *make_distribution({"beckmann", {{"alpha", .4}}, {}, {}});
  EXPECT_NEAR(d->masking(tilted(std::cos(45 * degree))), .999986, 5.1e-7);
  EXPECT_NEAR(d->masking(tilted(std::cos(75 * degree))), .911473, 5.1e-7);
  EXPECT_NEAR(d->masking(tilted(std::cos(85 * degree))), .540261, 5.1e-7);
  // Against Blinn-Phong of the same slope variance, alpha^2 = 2/(m+2).
  const auto ten = *make_distribution({"beckmann", {{"alpha", std::sqrt(2. / 12)}}, {}, {}});
  EXPECT_NEAR(ten->masking(tilted(std::cos(75 * degree))), .90685, 5.1e-6);
  const auto two_hundred =
      *make_distribution({"beckmann", {{"alpha", std::sqrt(2. / 202)}}, {}, {}});
  EXPECT_NEAR(two_hundred->masking(tilted(std::cos(85 * degree))), .96039, 5.1e-6);
}

TEST(Beckmann, IsADistribution) {
  for (const double alpha : {.01, .1, .4, 1.})
    check_distribution({"beckmann", {{"alpha", alpha}}, {}, {}}, 1e-6);
}

} // namespace
} // namespace umov
