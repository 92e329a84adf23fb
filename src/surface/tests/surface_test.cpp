#include "kernel/microfacet.inl.h"
#include "surface/masking.h"
#include "surface/tests/surface_cases.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/random.h>
#include <umov/surface/surface.h>

namespace umov {
namespace {

Surface make(const char *name, double m, Shadowing shadowing = Shadowing::Ashikhmin) {
  return make_surface(name, m, shadowing);
}

Masking masking_of(double m) {
  return Masking([m](double c) { return kernel::blinn_phong(c, m); },
                 std::min(pi / 2, 9 / std::sqrt(m + 2)));
}

double phase_cosine(double theta_l, double theta_v, double phi) {
  return std::cos(theta_l) * std::cos(theta_v) +
         std::sin(theta_l) * std::sin(theta_v) * std::cos(phi);
}

TEST(Masking, MatchesThePrintedValues) {
  // physics page, section 3, P(k) check, six digits.
  const double thetas[] = {30, 60, 75, 85, 89};
  const struct {
    double m, p[5];
  } rows[] = {{1, {.983178, .821021, .564563, .240034, .053357}},
              {10, {.999996, .990617, .886667, .508866, .132255}},
              {200, {1, 1, .999994, .959617, .462263}}};
  for (const auto &row : rows)
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_NEAR(masking_of(row.m)(std::cos(thetas[i] * degree)), row.p[i], 5.5e-7) << row.m;
}

TEST(Masking, HasItsClosedFormAtExponentZero) {
  // m = 0: P = 2 cos/(1 + cos).
  const Masking masking = masking_of(0);
  for (double c = 0.001; c < 1; c += 0.013)
    EXPECT_NEAR(masking(c), 2 * c / (1 + c), 2e-6);
}

TEST(Masking, TableFollowsTheIntegralForEveryExponent) {
  for (const double m : {0.0, 0.5, 1.0, 10.0, 200.0, 1e4, 1e6, 1e9}) {
    const Masking masking = masking_of(m);
    for (std::uint64_t i = 0; i < 200; ++i) {
      const auto u = uniform4(5, 1, i);
      const double c = std::min(1.0, u[0] * 8 / std::sqrt(m + 2));
      const double exact =
          std::min(1.0, c / Masking::integral(
                                c, [m](double x) { return kernel::blinn_phong(x, m); },
                                std::min(pi / 2, 9 / std::sqrt(m + 2))));
      EXPECT_NEAR(masking(c), exact, 2e-6 * exact) << m << " " << c;
    }
  }
}

TEST(Surface, WeightsMatchThePrintedValues) {
  // physics page, section 3, w = specular/((n.l)(n.v)); as many digits as printed.
  const struct {
    double m;
    Shadowing shadowing;
    double l, v, phi, w, tolerance;
  } rows[] = {{0, Shadowing::Separable, 30, 60, 90, .11372117, 3e-7},
              {10, Shadowing::Ashikhmin, 60, 60, 180, 1.87418697, 3e-6},
              {10, Shadowing::Smith, 60, 60, 180, 1.87435199, 3e-6},
              {10, Shadowing::Ashikhmin, 30, 60, 90, .12780082, 3e-7},
              {10, Shadowing::Ashikhmin, 70, 70, 0, 8.475e-5, 5.1e-9},
              {10, Shadowing::Smith, 70, 70, 0, 8.056e-5, 5.1e-9},
              {200, Shadowing::Ashikhmin, 30, 30, 180, 10.71643283, 3e-5},
              {200, Shadowing::Ashikhmin, 60, 60, 180, 32.14929850, 7e-5}};
  for (const auto &row : rows) { // the tolerance is that of the masking table, 2e-6 relative
    const Surface surface = make("paper_al", row.m, row.shadowing);
    const double l = row.l * degree, v = row.v * degree;
    const double w =
        specular_of(surface, std::cos(l), std::cos(v), phase_cosine(l, v, row.phi * degree)) /
        (std::cos(l) * std::cos(v));
    EXPECT_NEAR(w, row.w, row.tolerance) << row.m;
  }
}

TEST(Surface, WhiteFurnaceMatchesTheTable) {
  // Converged quadrature, four digits; E <= 1 is energy conservation. At 89.5 deg and m = 0 the
  // integral of the closed form P = 2c/(1+c) over the observer gives .84945 and .95855, at 85 deg
  // (smith) .78005; at m = 1 and 89.5 deg a separate quadrature of g and of the lobe gives .910010.
  const double thetas[] = {0, 30, 60, 75, 85, 89.5};
  const struct {
    double m;
    Shadowing shadowing;
    double e[6];
  } rows[] = {{0, Shadowing::Ashikhmin, {.3069, .3433, .4812, .6225, .7659, .8494}},
              {0, Shadowing::Smith, {.3069, .3352, .4507, .5906, .7801, .9585}},
              {1, Shadowing::Ashikhmin, {.4832, .5271, .6790, .8020, .8843, .9100}},
              {4, Shadowing::Ashikhmin, {.7849, .7882, .8338, .8883, .9306, .9477}},
              {10, Shadowing::Ashikhmin, {.9637, .9345, .8833, .8986, .9373, .9575}},
              {10, Shadowing::Smith, {.9637, .9345, .8831, .9009, .9550, .9949}},
              {50, Shadowing::Ashikhmin, {1.0000, .9998, .9727, .9148, .9257, .9609}},
              {200, Shadowing::Ashikhmin, {1.0000, 1.0000, .9998, .9751, .9122, .9580}},
              {1000, Shadowing::Ashikhmin, {1, 1, 1, 1.0000, .9490, .9484}},
              {10000, Shadowing::Ashikhmin, {1, 1, 1, 1, 1.0000, .9194}}};
  for (const auto &row : rows) {
    const Surface surface = make("paper_al", row.m, row.shadowing);
    for (std::size_t i = 0; i < 6; ++i) {
      const double e = surface.furnace_albedo(tilted(std::cos(thetas[i] * degree)));
      EXPECT_NEAR(e, row.e[i], 5.5e-5) << row.m << " " << thetas[i];
      EXPECT_LE(e, 1 + 1e-5);
    }
  }
}

TEST(Surface, BodyLobeMatchesThePrintedValues) {
  // physics page, section 3: a-Si 550, m = 200, R_sub = .1; half a unit of the sixth digit.
  const Surface surface = make("paper_asi", 200);
  const auto f = [&](double l, double v) {
    const double a = std::cos(l * degree), b = std::cos(v * degree);
    return body_of(surface, 1, a, b) / (a * b);
  };
  EXPECT_NEAR(f(0, 0), .018004, 6e-7);
  EXPECT_NEAR(f(30, 60), .018480, 6e-7);
  EXPECT_NEAR(f(60, 60), .018911, 6e-7);
}

TEST(Surface, SpectralonIsALambertianWithoutInterface) {
  const Surface surface = make("paper_spectralon", 200);
  EXPECT_EQ(surface.fresnel(0, 0.3).a, 0);
  EXPECT_NEAR(body_of(surface, 0, 0.5, 0.25), 0.125 / pi, 1e-15);
}

TEST(Surface, NormalReflectanceOfTableOne) {
  // physics page, section 2, F0, six digits.
  const struct {
    const char *name;
    double f0[3];
  } rows[] = {{"paper_au", {.390290, .841902, .939440}},
              {"paper_al", {.923052, .915377, .905602}},
              {"paper_bk7", {.043492, .042320, .041802}},
              {"paper_asi", {.455351, .426905, .401575}},
              {"paper_mylar", {.002268, .040000, .053254}}};
  for (const auto &row : rows)
    for (std::size_t b = 0; b < 3; ++b)
      EXPECT_NEAR(make(row.name, 200).fresnel(b, 1).a, row.f0[b], 5.1e-7);
}

TEST(Surface, IsReciprocalAndPhysical) {
  for (const Shadowing shadowing : {Shadowing::Ashikhmin, Shadowing::Smith,
                                    Shadowing::SmithDirectional, Shadowing::Separable}) {
    const Surface surface = make("paper_asi", 10, shadowing);
    for (std::uint64_t i = 0; i < 2000; ++i) {
      const auto u = uniform4(9, 4, i);
      const double l_v = phase_cosine(std::acos(u[0]), std::acos(u[1]), pi * u[2]);
      const auto there = surface.brdf(1, directions_from_cosines(u[0], u[1], l_v)).m,
                 back = surface.brdf(1, directions_from_cosines(u[1], u[0], l_v)).m;
      for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t c = 0; c < 4; ++c) { // M(v->l) = D M^T D, D = diag(1, 1, -1, 1)
          const double sign = (r == 2) != (c == 2) ? -1 : 1;
          EXPECT_NEAR(back[r][c], sign * there[c][r], 1e-12 * there[0][0]);
        }
      EXPECT_LE(std::abs(there[1][0]), there[0][0] * (1 + 1e-12));
    }
  }
}

TEST(Surface, IsFiniteAtEveryEdge) {
  for (const double m : {0.0, 200.0, 1e9})
    for (const Shadowing shadowing : {Shadowing::Ashikhmin, Shadowing::Smith,
                                      Shadowing::SmithDirectional, Shadowing::Separable}) {
      const Surface surface = make("paper_asi", m, shadowing);
      for (const double n_l : {-1.0, 0.0, 5e-324, 1e-300, 1e-12, 0.5, 1.0})
        for (const double n_v : {-1.0, 0.0, 5e-324, 1e-300, 1e-12, 0.5, 1.0})
          for (const double l_v : {-1.0, -1 + 1e-16, -0.5, 0.0, 0.5, 1.0}) {
            const double s = specular_of(surface, n_l, n_v, l_v), b = body_of(surface, 0, n_l, n_v);
            EXPECT_TRUE(std::isfinite(s) && s >= 0) << n_l << " " << n_v << " " << l_v;
            EXPECT_TRUE(std::isfinite(b) && b >= 0);
            const auto m00 = surface.brdf(0, directions_from_cosines(n_l, n_v, l_v)).m[0][0];
            EXPECT_TRUE(std::isfinite(m00) && m00 >= 0)
                << n_l << " " << n_v << " " << l_v << " " << m;
          }
    }
}

TEST(Material, IsRefusedOutsideItsTableAndWhenWrong) {
  const auto outside = Surface::compile(*builtin_material("paper_au"), *bands_from({"nm:800"}));
  ASSERT_FALSE(outside);
  EXPECT_NE(outside.error().message.find("covers 425-650 nm"), std::string::npos);
  const auto typo = builtin_material("paper_uu");
  EXPECT_NE(typo.error().message.find("Did you mean \"paper_au\"?"), std::string::npos);
  Material bad = *builtin_material("paper_au");
  bad.index.k.value[1] = -0.1;
  EXPECT_FALSE(check_material(bad));
  bad = *builtin_material("paper_au");
  bad.distribution = blinn_phong(-1);
  EXPECT_FALSE(check_material(bad));
  bad = *builtin_material("paper_au");
  std::get<Tabulated>(bad.index.n).wavelength_nm = {0.425, 0.55, 0.65};
  EXPECT_NE(check_material(bad).error().message.find("um"), std::string::npos);
}

} // namespace
} // namespace umov
