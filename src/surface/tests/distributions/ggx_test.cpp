#include "core/tests/anchors.h"
#include "surface/tests/distributions/distribution_cases.h"

namespace umov {
namespace {

TEST(Ggx, MaskingMatchesThePrintedValues) {
  for (const AnchorRow &row : Anchors("other_masking")) { // six digits
    if (row.text("model") != "ggx")
      continue;
    const auto d = *make_distribution({"ggx", {{"alpha", row["alpha"]}}, {}, {}});
    EXPECT_NEAR(d->masking(tilted(std::cos(row["theta_deg"] * degree))), row["p"], 5.1e-7);
  }
}

TEST(Ggx, IsADistribution) {
  for (const double alpha : {.02, .1, .4, 1., 2.})
    check_distribution({"ggx", {{"alpha", alpha}}, {}, {}}, 1e-6);
}

} // namespace
} // namespace umov
