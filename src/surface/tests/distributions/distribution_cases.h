#pragma once
// What every distribution of normals must obey.

#include "kernel/gauss.h"
#include "surface/tests/surface_cases.h"

#include <gtest/gtest.h>
#include <umov/core/random.h>

namespace umov {

/// Integral over the upper hemisphere in tan(theta/2)-like panels, fine near the normal.
template <class F> double hemisphere_integral(F f, double begin = 0) {
  double sum = 0, from = begin;
  for (double step = 1e-4; from < pi / 2; step *= 1.6) {
    const double end = std::min(from + step, pi / 2);
    sum += gauss_integral<24>(from, end, [&](double theta) {
      constexpr int azimuths = 256;
      double ring = 0;
      for (int i = 0; i < azimuths; ++i) {
        const double phi = 2 * pi * (i + 0.5) / azimuths;
        ring += f(Vec3<Facet>{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                              std::cos(theta)});
      }
      return std::sin(theta) * ring * 2 * pi / azimuths;
    });
    from = end;
  }
  return sum;
}

/// int D cos dw = 1; the visible projected area in every direction is n.k (the meaning of P); and
/// `beyond` is the integral of D.
inline void check_distribution(const DistributionChoice &choice, double tolerance) {
  const auto made = make_distribution(choice);
  ASSERT_TRUE(made) << made.error().message;
  const Distribution &d = **made;
  const double own = std::max(1e-6, 0.1 * tolerance); // a table has corners that the rule cuts
  EXPECT_NEAR(hemisphere_integral([&](Vec3<Facet> h) { return d.density(h) * h.z; }), 1, own);
  for (const double theta : {10., 50., 75., 86.})
    for (const double phi : {0.3, 1.2}) {
      const double s = std::sin(theta * degree);
      const Vec3<Facet> k{s * std::cos(phi), s * std::sin(phi), std::cos(theta * degree)};
      const double seen = d.masking(k) * hemisphere_integral([&](Vec3<Facet> h) {
                            return d.density(h) * std::max(0.0, dot(h, k));
                          });
      // The clip at h.k = 0 is a kink for the quadrature of this test: 1e-4 of n.k is its own
      // error.
      EXPECT_NEAR(seen, k.z, std::max(tolerance, 2e-4) * k.z) << choice.model << " " << theta;
    }
  if (!d.is_isotropic())
    return;
  const double edge = 3 * d.width();
  const double outer = hemisphere_integral([&](Vec3<Facet> h) { return d.density(h); }, edge);
  const double whole = hemisphere_integral([&](Vec3<Facet> h) { return d.density(h); });
  EXPECT_NEAR(d.beyond(1), whole, own * whole) << choice.model;
  EXPECT_NEAR(d.beyond(std::cos(edge)), outer, 10 * own * outer + 1e-25) << choice.model;
}

} // namespace umov
