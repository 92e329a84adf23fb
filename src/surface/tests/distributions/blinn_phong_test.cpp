#include "core/tests/anchors.h"
#include "surface/tests/distributions/distribution_cases.h"

namespace umov {
namespace {

TEST(BlinnPhong, IsADistribution) {
  for (const double m : {0., 1., 10., 200., 1e4})
    check_distribution(blinn_phong(m), 2e-6); // the tolerance is that of the table of masking
}

TEST(BlinnPhong, ApparentRoughnessScalesTheExponent) {
  // m at 425 and 650 nm for one at 550 nm and H = .8, so that slopes go with the power .25.
  for (const AnchorRow &row : Anchors("exponents")) {
    const auto d = *make_distribution(blinn_phong(row["m"]));
    const auto m_of = [](const auto &one) { return 1 / (one->width() * one->width()) - 2; };
    EXPECT_NEAR(m_of(d->scaled(std::pow(550. / 425, .25))), row["m_425"], 5.1e-4);
    EXPECT_NEAR(m_of(d->scaled(std::pow(550. / 650, .25))), row["m_650"], 5.1e-4);
  }
}

} // namespace
} // namespace umov
