#include "core/tests/anchors.h"
#include "surface/tests/distributions/distribution_cases.h"

namespace umov {
namespace {

TEST(Beckmann, MaskingMatchesThePrintedValues) {
  for (const AnchorRow &row : Anchors("other_masking")) { // six digits
    if (row.text("model") != "beckmann")
      continue;
    const auto d = *make_distribution({"beckmann", {{"alpha", row["alpha"]}}, {}, {}});
    EXPECT_NEAR(d->masking(tilted(std::cos(row["theta_deg"] * degree))), row["p"], 5.1e-7);
  }
}

TEST(Beckmann, IsADistribution) {
  for (const double alpha : {.01, .1, .4, 1.})
    check_distribution({"beckmann", {{"alpha", alpha}}, {}, {}}, 1e-6);
}

} // namespace
} // namespace umov
