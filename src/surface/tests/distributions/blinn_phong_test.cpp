#include "surface/tests/distributions/distribution_cases.h"

namespace umov {
namespace {

TEST(BlinnPhong, IsADistribution) {
  for (const double m : {0., 1., 10., 200., 1e4})
    check_distribution(blinn_phong(m), 2e-6); // the tolerance is that of the table of masking
}

TEST(BlinnPhong, ApparentRoughnessScalesTheExponent) {
  // physics page, section 5: m(425) and m(650) for m0 = 10, 100, 1000 at 550 nm with q = .25.
  const struct {
    double m, blue, red;
  } rows[] = {{10, 8.549, 11.045}, {100, 87.663, 108.886}, {1000, 878.807, 1087.289}};
  for (const auto &row : rows) {
    const auto d = *make_distribution(blinn_phong(row.m));
    const auto m_of = [](const auto &one) { return 1 / (one->width() * one->width()) - 2; };
    EXPECT_NEAR(m_of(d->scaled(std::pow(550. / 425, .25))), row.blue, 5.1e-4);
    EXPECT_NEAR(m_of(d->scaled(std::pow(550. / 650, .25))), row.red, 5.1e-4);
  }
}

} // namespace
} // namespace umov
