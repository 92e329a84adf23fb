// Haze: the floor under every lobe.

#include "surface/tests/surface_cases.h"

#include <gtest/gtest.h>
#include <umov/core/random.h>
#include <umov/surface/audit.h>

namespace umov {
namespace {

const Stokes<ScatteringPlane> sunlight{1, 0, 0, 0};

Material hazy(std::complex<double> eta, Haze haze) {
  Material out;
  out.name = "hazy";
  out.index = constant_index(eta);
  out.distribution = {"beckmann", {{"alpha", 0.03}}, {}, {}, {}};
  out.haze = haze;
  return out;
}

SurfaceDirections angles(double i, double o, double phi) {
  return directions_from_angles(i * degree, o * degree, phi * degree);
}

TEST(Haze, IsALambertSurfaceFarFromTheLobe) {
  // Diffuse light reflects from n = 1.5 by .0918 (Judd 1942, J. Res. NBS 29, 329: table 1, four
  // digits), whatever the direction: 60 deg from a lobe of 1.7 deg there is nothing else.
  const Surface glass = compiled(hazy(1.5, {.share = 0.02}), "nm:550");
  for (const double theta_o : {0., 40., 70.}) {
    const auto f = glass.brdf(0, angles(60, theta_o, 0)).m;
    EXPECT_NEAR(f[0][0], 0.02 * 0.0918 / pi, 0.02 * 5e-5 / pi);
    EXPECT_NEAR(f[1][0] / f[0][0], 0, 1e-100);
  }
  const Surface white = compiled(hazy(1.5, {.share = 0.009, .is_white = true}), "nm:550");
  EXPECT_NEAR(white.brdf(0, angles(60, 30, 0)).m[0][0], 0.009 / pi, 1e-15);
  EXPECT_NEAR(white.terms(0, angles(60, 30, 0)).haze, 0.009 / pi, 1e-15);
}

TEST(Haze, TakesFromTheLobeWhatItGives) {
  // A perfect conductor sends everything back, hazy or not; 2e-4: quadrature of the lobe.
  const Material metal = hazy({1, 1e6}, {.share = 0.3});
  const Surface surface = compiled(metal, "nm:550");
  for (const double theta : {0., 30., 60.}) {
    const Vec3<Facet> k = tilted(std::cos(theta * degree));
    EXPECT_NEAR(surface.albedo(0, k), 1, 2e-4);
    EXPECT_NEAR(surface.specular_albedo(0, k), 0.7, 2e-4);
  }
  Material clear = metal;
  clear.haze.reset();
  const auto at = angles(30, 30, 180);
  EXPECT_NEAR(surface.brdf(0, at).m[0][0],
              0.7 * compiled(clear, "nm:550").brdf(0, at).m[0][0] + 0.3 / pi, 1e-9);
}

TEST(Haze, OfSteepSlopesPolarizesAsOneReflection) {
  const Surface gold = make_surface("paper_au", 200);
  Material material = gold.material();
  material.haze = Haze{.share = 0.1, .is_polarized = true};
  const Surface surface = compiled(material);
  for (std::uint64_t i = 0; i < 50; ++i) {
    const auto u = uniform4(5, 1, i);
    const auto at = directions(direction_from(u[0], u[1]), direction_from(u[2], u[3]));
    for (std::size_t b = 0; b < 3; ++b) {
      const FresnelFactors f = gold.fresnel(b, at.l_v);
      const auto m = surface.brdf(b, at).m;
      EXPECT_NEAR(m[1][0] / m[0][0], f.b / f.a, 1e-12);
    }
  }
}

TEST(Haze, KeepsTheLawsBesideEveryOtherLight) {
  Material all = hazy({1.5, 0.0}, {.share = 0.2, .is_polarized = true});
  all.body = BodyLobe{{{}, {0.9}}, true};
  all.interreflection = Interreflection::SingleBounceQ;
  all.distribution = {"ggx", {{"alpha", 0.5}}, {}, {}, {}};
  for (const bool is_white : {false, true}) {
    all.haze->is_white = is_white;
    all.haze->is_polarized = !is_white;
    const SurfaceAudit audit = audit_surface(compiled(all), 2000, 7);
    EXPECT_TRUE(audit.is_fine()) << audit.reciprocity << ' ' << audit.cloude_min << ' '
                                 << audit.albedo_max << ' ' << audit.energy_gap;
  }
}

TEST(Haze, RefusesWhatCannotBe) {
  EXPECT_FALSE(check_material(hazy(1.5, {.share = 1.1})));
  EXPECT_FALSE(check_material(hazy(1.5, {.share = -0.1})));
  EXPECT_FALSE(check_material(hazy(1.5, {.share = 0.1, .low = 0.2, .high = 0.3})));
  EXPECT_FALSE(check_material(hazy(1.5, {.share = 0.1, .is_white = true, .is_polarized = true})));
  EXPECT_TRUE(check_material(hazy(1.5, {.share = 0.1, .low = 0.05, .high = 0.3})));
}

} // namespace
} // namespace umov
