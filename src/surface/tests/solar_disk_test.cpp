#include "surface/solar_disk.h"

#include "core/tests/anchors.h"
#include "surface/tests/surface_cases.h"

#include <gtest/gtest.h>
#include <umov/core/random.h>

namespace umov {
namespace {

constexpr double radius = 0.2665 * degree; // the Sun from 1 au
const double solid_angle = 2 * pi * (1 - std::cos(radius));

/// The mean over the disk by very many directions: the oracle of this file.
double by_brute_force(const Distribution &d, Vec3<Facet> l, Vec3<Facet> v) {
  constexpr int rings = 400, spokes = 256;
  const Vec3<Facet> a = any_perpendicular(l), b = cross(l, a);
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double r = radius * std::sqrt((i + 0.5) / rings);
    for (int k = 0; k < spokes; ++k) {
      const double phi = 2 * pi * (k + 0.5) / spokes;
      const Vec3<Facet> source =
          std::cos(r) * l + std::sin(r) * (std::cos(phi) * a + std::sin(phi) * b);
      sum += d.density(normalized(source + v));
    }
  }
  return sum / (rings * spokes);
}

struct Case {
  Vec3<Facet> l, v;
};

/// A pose of that phase whose half vector leans by `tilt` from the normal towards `azimuth`.
Case pose(double phase, double tilt, double azimuth) {
  const Vec3<Facet> h{std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                      std::cos(tilt)};
  const Vec3<Facet> e = normalized(Vec3<Facet>{1, 0, 0} - h.x * h);
  const double half = phase / 2;
  return {std::cos(half) * h + std::sin(half) * e, std::cos(half) * h - std::sin(half) * e};
}

TEST(SolarDisk, EveryRegimeAgreesWithBruteForce) {
  for (const double phase : {10., 60., 110., 140.})
    for (const double m : {10., 200., 1e3, 3e3, 1e4, 3e4, 1e5, 1e6}) {
      const auto d = *make_distribution(blinn_phong(m));
      const double peak =
          by_brute_force(*d, pose(phase * degree, 0, 0).l, pose(phase * degree, 0, 0).v);
      for (const double tilt : {0., .5, 1., 2.})
        for (const double azimuth : {0., 1., 1.57}) {
          // From the lobe's and the disk's own widths, whichever is larger.
          const double scale =
              std::max(1 / std::sqrt(m), radius / 4 / std::cos(phase / 2 * degree));
          const Case c = pose(phase * degree, tilt * scale, azimuth);
          const double exact = by_brute_force(*d, c.l, c.v);
          const double ours = density_over_disk(*d, c.l, c.v, dot(c.l, c.v), radius);
          EXPECT_NEAR(ours, exact, 2e-3 * peak)
              << m << " " << phase << " " << tilt << " " << azimuth;
        }
    }
}

TEST(SolarDisk, IsContinuousAcrossItsSwitches) {
  for (const double tilt : {0., .7, 1.5}) {
    double before = 0;
    for (double m = 100; m < 3e6; m *= 1.002) {
      const auto d = *make_distribution({"beckmann", {{"alpha", std::sqrt(2 / (m + 2))}}, {}, {}});
      const Case c = pose(80 * degree, tilt / std::sqrt(m), 0.6);
      const double value =
          density_over_disk(*d, c.l, c.v, dot(c.l, c.v), radius) / d->density(tilted(1));
      if (before > 0) { // a smooth curve moves by little more than the step of 0.2 %
        EXPECT_NEAR(value, before, 0.003 * std::max(before, value)) << m << " " << tilt;
      }
      before = value;
    }
  }
}

TEST(SolarDisk, OtherLobesAgreeWithBruteForce) {
  for (const DistributionChoice &choice :
       {DistributionChoice{"ggx", {{"alpha", .05}}, {}, {}},
        DistributionChoice{"ggx", {{"alpha", .004}}, {}, {}},
        DistributionChoice{"beckmann", {{"alpha", .01}}, {}, {}},
        DistributionChoice{"ashikhmin_shirley", {{"nu", 2000}, {"nv", 1e5}}, {}, {}}}) {
    const auto d = *make_distribution(choice);
    for (const double tilt : {0., .002, .005}) {
      const Case c = pose(70 * degree, tilt, 0.7), top = pose(70 * degree, 0, 0);
      EXPECT_NEAR(density_over_disk(*d, c.l, c.v, dot(c.l, c.v), radius),
                  by_brute_force(*d, c.l, c.v), 3e-3 * by_brute_force(*d, top.l, top.v))
          << choice.model << " " << tilt;
    }
  }
}

TEST(SolarDisk, AMirrorShowsTheDisk) {
  // J = F A cos(phase/2)/Omega inside the cone; gain 1/Omega.
  Material mirror;
  mirror.distribution = {"mirror", {}, {}, {}};
  mirror.index = constant_index({1.0, 1e3});
  const Surface surface = compiled(mirror, "nm:550");
  EXPECT_NEAR(1 / solid_angle, anchor("mirror_plate_gain"), 1);
  for (const double phase : {0.001, 40., 120.}) {
    const Case inside = pose(phase * degree, 0.4 * radius / 2, 0.3);
    const double w = surface.specular(0, directions(inside.l, inside.v, radius));
    // The incidence is that on the plate: off the centre it is not quite half the phase angle.
    const double expected = inside.v.z / solid_angle;
    EXPECT_NEAR(w, expected, 3e-5 * expected) << phase;
    const Case outside = pose(phase * degree, 1.1 * radius / 2, 0); // along the plane: radius/2
    EXPECT_LT(surface.specular(0, directions(outside.l, outside.v, radius)), 1e-9 * expected);
  }
}

} // namespace
} // namespace umov
