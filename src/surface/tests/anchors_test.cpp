// Numbers of tests/data/anchors, by quadrature of Surface.

#include "core/tests/anchors.h"
#include "kernel/fresnel.inl.h"
#include "kernel/microfacet.inl.h"
#include "surface/tests/surface_cases.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/random.h>
#include <umov/surface/surface.h>

namespace umov {
namespace {

Surface with_exponent(const char *name, double m, bool body = false) {
  Material material = *builtin_material(name);
  material.distribution = blinn_phong(m);
  if (!body)
    material.body.reset();
  return *Surface::compile(material, *bands_from({"paper_rgb"}));
}

double q_of(const Surface &surface, std::size_t band, double phase_deg) {
  const FresnelFactors f = surface.fresnel(band, std::cos(phase_deg * pi / 180));
  return f.b / f.a;
}

TEST(Anchors, CosineWeightedMeanReflectance) {
  // Six digits: 2 int F mu dmu, here with mu = cos of incidence = cos(phase/2).
  for (const AnchorRow &row : Anchors("table1")) {
    double sum = 0;
    constexpr int steps = 4000; // in sqrt(mu): F rises steeply at grazing incidence
    const Surface surface = with_exponent(row.text("material").c_str(), 200);
    for (int i = 0; i < steps; ++i) {
      const double root = (i + 0.5) / steps, mu = root * root;
      sum += surface.fresnel(band_of(row), 2 * mu * mu - 1).a * 4 * root * root * root / steps;
    }
    EXPECT_NEAR(sum, row["f_mean"], 6e-7) << row.text("material") << row.text("nm");
  }
}

TEST(Anchors, PeaksOfQ) {
  for (const AnchorRow &row : Anchors("q_peak")) { // six digits, and .01 deg in steps of .001
    const Surface surface = with_exponent(row.text("material").c_str(), 200);
    double best = 0, at = 0;
    for (double phase = row["phase_deg"] - 1; phase < row["phase_deg"] + 1; phase += 0.001)
      if (const double q = q_of(surface, band_of(row), phase); q > best) {
        best = q;
        at = phase;
      }
    EXPECT_NEAR(best, row["q"], 6e-7) << row.text("material");
    EXPECT_NEAR(at, row["phase_deg"], 0.0062) << row.text("material");
  }
}

TEST(Anchors, StokesOfSpheresAt90Degrees) {
  // (M00, M10), R = 1, seven digits; the midpoint rule adds below 2e-7.
  for (const AnchorRow &row : Anchors("sphere_stokes")) {
    const std::string &name = row.text("material");
    const FresnelFactors f =
        sphere(with_exponent(name.c_str(), row["m"]), band_of(row), pi / 2, 1000);
    EXPECT_NEAR(f.a, row["i"], 3e-7) << name;
    EXPECT_NEAR(f.b, row["q"], 3e-7) << name;
  }
}

TEST(Anchors, LambertSphere) {
  const Surface surface = with_exponent("paper_spectralon", 200, true);
  for (const AnchorRow &row : Anchors("lambert_sphere")) // six digits, and the midpoint rule
    EXPECT_NEAR(sphere(surface, 0, row["phase_deg"] * pi / 180, 1000).a, row["j"], 2e-6);
}

TEST(Anchors, EveryReflectionIsPhysical) {
  // A reflection by one interface is pure: its Cloude matrix has the one eigenvalue 2A, so
  // A^2 = B^2 + |z|^2; unpolarized body light only adds to A. At least -1e-9 of that is asked.
  for (const char *name : {"paper_au", "paper_al", "paper_bk7", "paper_asi", "paper_mylar"}) {
    const Surface surface = with_exponent(name, 200, true);
    for (std::uint64_t k = 0; k < 500; ++k) {
      const auto u = uniform4(4, 4, k);
      const auto m = surface.brdf(k % 3, directions_from_cosines(u[0], u[1], 2 * u[2] - 1)).m;
      const double pure = m[1][0] * m[1][0] + m[2][2] * m[2][2] + m[3][2] * m[3][2];
      EXPECT_GE(m[0][0] * m[0][0] - pure, -1e-9 * m[0][0] * m[0][0]);
    }
  }
}

TEST(Anchors, NormOfDIsOneForEveryExponent) {
  // int D cos dw = 1 within 1e-6; substitution t = cos^(m+2) makes the integrand 1.
  for (const double m : {0.0, 1.0, 200.0, 1e6, 1e9}) {
    double sum = 0;
    constexpr int steps = 20000;
    const double last = std::min(pi / 2, 9 / std::sqrt(m + 2));
    for (int i = 0; i < steps; ++i) {
      const double theta = last * (i + 0.5) / steps;
      sum += 2 * pi * kernel::blinn_phong(std::cos(theta), m) * std::cos(theta) * std::sin(theta) *
             last / steps;
    }
    EXPECT_NEAR(sum, 1, 1e-6) << m;
  }
}

TEST(Anchors, FloatKernelsFollowDouble) {
  // Single precision: 24 bits, some 20 operations, 3e-6; D at m = 200 multiplies the rounding of
  // the cosine by m.
  for (std::uint64_t k = 0; k < 2000; ++k) {
    const auto u = uniform4(5, 5, k);
    const auto d = kernel::reflection(
        kernel::fresnel(u[0], kernel::Complex<double>{0.2 + 3 * u[1], 4 * u[2]}));
    const auto f = kernel::reflection(kernel::fresnel(
        static_cast<float>(u[0]),
        kernel::Complex<float>{static_cast<float>(0.2 + 3 * u[1]), static_cast<float>(4 * u[2])}));
    EXPECT_NEAR(static_cast<double>(f.a), d.a, 5e-6);
    EXPECT_NEAR(static_cast<double>(f.b), d.b, 5e-6);
    const double c = 0.8 + 0.2 * u[3], exact = kernel::blinn_phong(c, 200.0);
    EXPECT_NEAR(static_cast<double>(kernel::blinn_phong(static_cast<float>(c), 200.0f)), exact,
                3e-5 * exact + 1e-30);
  }
}

TEST(Anchors, BodyLobeTakesWhatTheInterfaceLeaves) {
  // Directional albedo of the body lobe: R_sub (1 - R(k)), by Simpson over the observer.
  const Surface surface = with_exponent("paper_asi", 200, true);
  for (const double n_l : {0.2, 0.6, 1.0}) {
    double sum = 0;
    constexpr int steps = 2000;
    for (int i = 0; i < steps; ++i) {
      const double root = (i + 0.5) / steps, mu = root * root;
      sum += body_of(surface, 1, n_l, mu) / n_l * 2 * pi * 2 * root / steps;
    }
    EXPECT_NEAR(sum, 0.1 * (1 - surface.specular_albedo(1, tilted(n_l))), 1e-6);
  }
}

} // namespace
} // namespace umov
