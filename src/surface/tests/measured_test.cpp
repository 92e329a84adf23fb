#include "surface/tests/surface_cases.h"

#include <gtest/gtest.h>
#include <umov/core/random.h>
#include <umov/surface/measured.h>

namespace umov {
namespace {

/// A model sampled in the plane of incidence, as a goniometer would.
std::vector<BrdfSample> sampled_in_plane(const Surface &surface) {
  std::vector<BrdfSample> out;
  for (double i = 0; i <= 80; i += 10)
    for (double o = 0; o <= 85; o += 1)
      for (const double phi : {0., 180.}) {
        const auto at = directions_from_angles(i * degree, o * degree, phi * degree);
        out.push_back({550, i, o, phi, {surface.brdf(0, at).m[0][0]}});
      }
  return out;
}

TEST(Measured, ALobeSampledInThePlaneComesBackOutOfIt) {
  // Beckmann, alpha .15, on a conductor: its BRDF depends on the tilt of h mostly, on the rest
  // slowly.
  Material metal;
  metal.index = constant_index({.359, 2.69});
  metal.distribution = {"beckmann", {{"alpha", .15}}, {}, {}, {}};
  const Surface surface = compiled(metal, "nm:550");
  std::vector<std::string> remarks;
  const auto measured = MeasuredBrdf::from(sampled_in_plane(surface), false, false, remarks);
  ASSERT_TRUE(measured) << measured.error().message;
  EXPECT_EQ(remarks.size(), 1u);
  EXPECT_NEAR(measured->albedo(550, 30 * degree),
              surface.specular_albedo(0, tilted(std::cos(30 * degree))), .02);
  double worst = 0, peak = 0;
  for (std::uint64_t k = 0; k < 500; ++k) {
    const auto u = uniform4(8, 3, k);
    const double i = 60 * u[0], o = 60 * u[1], phi = 360 * u[2];
    const double truth =
        surface.brdf(0, directions_from_angles(i * degree, o * degree, phi * degree)).m[0][0];
    const double ours = (*measured)(550, i * degree, o * degree, phi * degree)[0];
    worst = std::max(worst, std::abs(ours - truth));
    peak = std::max(peak, truth);
    // Reciprocity is exact by construction.
    EXPECT_NEAR((*measured)(550, o * degree, i * degree, phi * degree)[0], ours, 1e-9 * (1 + ours));
  }
  // Steps of 10 deg of incidence: linear between curves whose masking and Fresnel factors differ.
  EXPECT_LT(worst, 0.08 * peak);
}

TEST(Measured, AMuellerTableIsReciprocalToTheLastBit) {
  Material paint;
  paint.index = constant_index(1.5);
  paint.distribution = {"beckmann", {{"alpha", .4}}, {}, {}, {}};
  paint.body = BodyLobe{{{}, {.5}}, true};
  const Surface surface = compiled(paint, "nm:550");
  std::vector<BrdfSample> samples;
  for (const double i : {0., 20., 40., 60., 80.})
    for (const double o : {0., 20., 40., 60., 80.})
      for (const double phi : {0., 45., 90., 135., 180.}) {
        BrdfSample s{550, i, o, phi, {}};
        const auto m =
            surface.brdf(0, directions_from_angles(i * degree, o * degree, phi * degree)).m;
        for (std::size_t k = 0; k < 16; ++k)
          s.mueller[k] = m[k / 4][k % 4];
        samples.push_back(s);
      }
  std::vector<std::string> remarks;
  const auto measured = MeasuredBrdf::from(samples, true, false, remarks);
  ASSERT_TRUE(measured) << measured.error().message;
  EXPECT_LT(measured->worst_asymmetry(), 1e-12);
  Material material;
  material.name = "m";
  material.measured = std::make_shared<MeasuredBrdf>(*measured);
  const Surface table = compiled(material, "nm:550");
  for (std::uint64_t k = 0; k < 300; ++k) {
    const auto u = uniform4(8, 4, k);
    const Vec3<Facet> l = direction_from(u[0], u[1]), v = direction_from(u[2], u[3]);
    const auto there = table.brdf(0, directions(l, v)).m, back = table.brdf(0, directions(v, l)).m;
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(back[r][c], ((r == 2) != (c == 2) ? -1 : 1) * there[c][r], 1e-12 * there[0][0]);
  }
}

} // namespace
} // namespace umov
