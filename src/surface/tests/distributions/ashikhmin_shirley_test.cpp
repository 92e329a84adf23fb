#include "core/tests/anchors.h"
#include "surface/tests/distributions/distribution_cases.h"

namespace umov {
namespace {

DistributionChoice choice(double nu, double nv) {
  return {"ashikhmin_shirley", {{"nu", nu}, {"nv", nv}}, {}, {}};
}

TEST(AshikhminShirley, EqualExponentsAreBlinnPhong) {
  const auto a = *make_distribution(choice(50, 50)), b = *make_distribution(blinn_phong(50));
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto u = uniform4(2, 7, i);
    const Vec3<Facet> h = direction_from(u[0], u[1]), k = direction_from(u[2], u[3]);
    EXPECT_NEAR(a->density(h), b->density(h), 1e-12 * (1 + b->density(h)));
    EXPECT_NEAR(a->masking(k), b->masking(k), 1e-5);
  }
}

TEST(AshikhminShirley, MeanCosineIsExact) {
  // <n.h> = int D cos / int D = 1/int D, in closed form (lobes.md, Eq. 1); six digits.
  const auto d = *make_distribution(choice(20, 200));
  const double area = hemisphere_integral([&](Vec3<Facet> h) { return d->density(h); });
  EXPECT_NEAR(1 / area, anchor("ashikhmin_shirley_mean_cosine"), 5.1e-7);
  EXPECT_NEAR(1 / area, std::sqrt(21. * 201 / (22. * 202)), 1e-8);
}

TEST(AshikhminShirley, IsADistribution) {
  check_distribution(choice(20, 200), 3e-5); // the table of masking in two coordinates
  check_distribution(choice(400, 10), 3e-5);
}

} // namespace
} // namespace umov
