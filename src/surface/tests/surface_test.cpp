#include "core/tests/anchors.h"
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

Shadowing shadowing_of(const AnchorRow &row) {
  const std::string &name = row.text("shadowing");
  return name == "ashikhmin" ? Shadowing::Ashikhmin
         : name == "smith"   ? Shadowing::Smith
                             : Shadowing::Separable;
}

double phase_cosine(double theta_l, double theta_v, double phi) {
  return std::cos(theta_l) * std::cos(theta_v) +
         std::sin(theta_l) * std::sin(theta_v) * std::cos(phi);
}

TEST(Masking, MatchesThePrintedValues) {
  for (const AnchorRow &row : Anchors("masking")) // six digits
    EXPECT_NEAR(masking_of(row["m"])(std::cos(row["theta_deg"] * degree)), row["p"], 5.5e-7)
        << row["m"];
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
  // w = specular/((n.l)(n.v)) to half a digit and 2e-6, the tolerance of the masking table.
  for (const AnchorRow &row : Anchors("weights")) {
    const Surface surface = make("paper_al", row["m"], shadowing_of(row));
    const double l = row["theta_l_deg"] * degree, v = row["theta_v_deg"] * degree;
    const double l_v = phase_cosine(l, v, row["phi_deg"] * degree);
    const double w =
        specular_of(surface, std::cos(l), std::cos(v), l_v) / (std::cos(l) * std::cos(v));
    EXPECT_NEAR(w, row["w"], row.half_digit("w") + 2e-6 * row["w"]) << row["m"];
  }
}

TEST(Surface, WhiteFurnaceMatchesTheTable) {
  // Four digits; E <= 1 is energy conservation.
  for (const AnchorRow &row : Anchors("furnace")) {
    const Surface surface = make("paper_al", row["m"], shadowing_of(row));
    const double e = surface.furnace_albedo(tilted(std::cos(row["theta_deg"] * degree)));
    EXPECT_NEAR(e, row["e"], 5.5e-5) << row["m"] << " " << row["theta_deg"];
    EXPECT_LE(e, 1 + 1e-5);
  }
}

TEST(Surface, BodyLobeMatchesThePrintedValues) {
  // a-Si 550, m = 200, R_sub = .1; half a unit of the sixth digit.
  const Surface surface = make("paper_asi", 200);
  const auto f = [&](double l, double v) {
    const double a = std::cos(l * degree), b = std::cos(v * degree);
    return body_of(surface, 1, a, b) / (a * b);
  };
  for (const AnchorRow &row : Anchors("body"))
    EXPECT_NEAR(f(row["theta_l_deg"], row["theta_v_deg"]), row["f"], 6e-7);
}

TEST(Surface, SpectralonIsALambertianWithoutInterface) {
  const Surface surface = make("paper_spectralon", 200);
  EXPECT_EQ(surface.fresnel(0, 0.3).a, 0);
  EXPECT_NEAR(body_of(surface, 0, 0.5, 0.25), 0.125 / pi, 1e-15);
}

TEST(Surface, NormalReflectanceOfTableOne) {
  for (const AnchorRow &row : Anchors("table1")) // six digits
    EXPECT_NEAR(make(row.text("material").c_str(), 200).fresnel(band_of(row), 1).a, row["f0"],
                5.1e-7);
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
