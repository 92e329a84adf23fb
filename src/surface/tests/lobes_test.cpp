// Body light, inter-reflection, apparent roughness, films, emission and transmission.

#include "core/tests/anchors.h"
#include "surface/tests/surface_cases.h"

#include <gtest/gtest.h>
#include <umov/core/random.h>
#include <umov/surface/rough_emission.h>
#include <umov/surface/rough_transmission.h>

namespace umov {
namespace {

const Stokes<ScatteringPlane> sunlight{1, 0, 0, 0};

SurfaceDirections angles(double i, double o, double phi) {
  return directions_from_angles(i * degree, o * degree, phi * degree);
}

TEST(PolarizedBody, MatchesThePrintedValues) {
  // a-Si 550, R_sub = .1, seven digits.
  Material si = *builtin_material("paper_asi");
  si.body->is_polarized = true;
  const Surface surface = compiled(si);
  const auto f = [&](double phi) {
    const auto at = angles(30, 60, phi);
    return surface.diffuse(1, at, sunlight) * (1 / (at.l.z * at.v.z));
  };
  for (const AnchorRow &row : Anchors("polarized_body")) {
    const auto light = f(row["phi_deg"]);
    EXPECT_NEAR(light.i, row["i"], 5.1e-8);
    EXPECT_NEAR(light.q, row["q"], 5.1e-8);
    EXPECT_NEAR(std::abs(light.u), row["abs_u"], row["abs_u"] > 0 ? 5.1e-8 : 1e-15);
  }
  EXPECT_NEAR(f(270).u, -f(90).u, 1e-15); // mirrored azimuth
  EXPECT_EQ(f(90).v, 0);
  // n = 1.5, R_sub = 1, normal incidence, seen at 80 deg.
  Material glass;
  glass.index = constant_index(1.5);
  glass.body = BodyLobe{{{}, {1}}, true};
  const auto s = compiled(glass, "nm:550").diffuse(0, angles(0, 80, 0), sunlight);
  EXPECT_NEAR(s.q / s.i, anchor("polarized_body_n1.5_80"), 5.1e-7);
}

TEST(PolarizedBody, UHasTheSignOfFieldsInThreeDimensions) {
  // Light leaving along v is p-polarized about n: its electric vector lies in the plane (n, v).
  // Position angle of that vector from s, counter-clockwise as the observer sees it.
  Material si = *builtin_material("paper_asi");
  si.body->is_polarized = true;
  const Surface surface = compiled(si);
  for (std::uint64_t i = 0; i < 100; ++i) {
    const auto u = uniform4(4, 1, i);
    const Vec3<Facet> l = direction_from(u[0], u[1]), v = direction_from(u[2], u[3]);
    const auto f = surface.diffuse(1, directions(l, v), sunlight);
    const Vec3<Facet> n{0, 0, 1}, s = normalized(cross(v, l)), p = cross(v, s);
    const Vec3<Facet> field = normalized(n - dot(n, v) * v);
    const double x = dot(field, s), y = dot(field, p);
    const double size = std::hypot(f.q, f.u);
    // Q = |Es|^2 - |Ep|^2, U = 2 Re(Es Ep*).
    EXPECT_NEAR(f.q, size * (x * x - y * y), 1e-12 * size);
    EXPECT_NEAR(f.u, size * 2 * x * y, 1e-12 * size);
  }
}

TEST(Interreflection, MatchesThePrintedValue) {
  // Au 550, m = 10, ashikhmin, monostatic at 30 deg; six and seven digits.
  Material gold = *builtin_material("paper_au");
  gold.distribution = blinn_phong(10);
  gold.interreflection = Interreflection::Unpolarized;
  const Surface surface = compiled(gold);
  const auto terms = surface.terms(1, angles(30, 30, 0));
  EXPECT_NEAR(terms.specular, anchor("gold_once_30"), 5.1e-7);
  EXPECT_NEAR(terms.interreflection, anchor("gold_between_30"), 1e-7);
  // Active source: the degree of polarization of linear light sent straight back.
  const auto m = surface.brdf(1, angles(30, 30, 0));
  EXPECT_NEAR(m.m[1][1] / m.m[0][0], anchor("gold_degree_30"), 1e-6);
  EXPECT_LT(m.m[3][3], 0); // the other helicity
}

TEST(Interreflection, ClosesTheFurnace) {
  // A perfect conductor sends everything out: albedo 1 within 2e-4 for every roughness.
  for (const double m : {0., 1., 4., 10., 50., 200.})
    for (const Shadowing shadowing : {Shadowing::Ashikhmin, Shadowing::Smith}) {
      Material perfect;
      perfect.index = constant_index({1, 1e9});
      perfect.distribution = blinn_phong(m);
      perfect.shadowing = shadowing;
      perfect.interreflection = Interreflection::Unpolarized;
      const Surface surface = compiled(perfect, "nm:550");
      for (const double theta : {0., 30., 60., 80., 88.})
        EXPECT_NEAR(surface.albedo(0, tilted(std::cos(theta * degree))), 1, 2e-4)
            << m << " " << theta;
    }
}

TEST(Interreflection, SingleBounceQKeepsTheRatio) {
  Material gold = *builtin_material("paper_au");
  gold.distribution = blinn_phong(4);
  gold.interreflection = Interreflection::SingleBounceQ;
  const Surface surface = compiled(gold);
  for (const double phi : {20., 90., 170.}) {
    const auto at = angles(50, 60, phi);
    const auto m = surface.brdf(0, at);
    const auto f = surface.fresnel(0, at.l_v);
    EXPECT_NEAR(m.m[1][0] / m.m[0][0], f.b / f.a, 1e-12);
  }
}

TEST(Interreflection, SphereOfGoldMatchesThePrintedValues) {
  // Au 425 sphere at phase 90: one reflection, then with unpolarized f_ms. Four digits; six, of
  // which the midpoint rule below leaves 2e-5.
  const auto q_of = [](double m, Interreflection kind) {
    Material gold = *builtin_material("paper_au");
    gold.distribution = blinn_phong(m);
    gold.interreflection = kind;
    const Surface surface = compiled(gold, "nm:425");
    const Vec3<Facet> l{1, 0, 0}, v{0, 1, 0};
    double i = 0, q = 0;
    constexpr int steps = 400;
    for (int a = 0; a < steps; ++a)
      for (int b = 0; b < steps; ++b) {
        const double z = -1 + (2 * a + 1.0) / steps, phi = pi / 2 * (b + 0.5) / steps;
        const double s = std::sqrt(1 - z * z);
        const Vec3<Facet> n{s * std::cos(phi), s * std::sin(phi), z};
        const auto at = directions_from_cosines(dot(n, l), dot(n, v), 0);
        const auto f = surface.fresnel(0, 0);
        const double w = surface.specular(0, at);
        i += f.a * w + surface.diffuse(0, at, sunlight).i;
        q += f.b * w;
      }
    return q / i;
  };
  for (const AnchorRow &row : Anchors("gold_sphere")) {
    const bool once = row.text("interreflection") == "none";
    EXPECT_NEAR(q_of(row["m"], once ? Interreflection::None : Interreflection::Unpolarized),
                row["q"], once ? 5.1e-5 : 2e-5);
  }
}

TEST(ApparentRoughness, RatiosOfTheGoldPlate) {
  // I(425)/I(650), in plane, 60 deg, on the specular side. 2e-6 of masking allows six digits; where
  // the ratio is thousands, two intensities of nothing are compared: left out.
  for (const AnchorRow &row : Anchors("rough_gold_colour")) {
    if (row["ratio"] > 1e3)
      continue;
    Material gold = *builtin_material("paper_au");
    gold.distribution = blinn_phong(row["m"]);
    gold.apparent_roughness = ApparentRoughness{0.8, 550, std::nullopt};
    const Surface surface = compiled(gold);
    const auto at = angles(60, row["theta_v_deg"], 180);
    const auto i = [&](std::size_t b) { return surface.terms(b, at).specular; };
    EXPECT_NEAR(i(0) / i(2), row["ratio"], 1.2e-5 * std::max(1.0, row["ratio"]))
        << row["m"] << " " << row["theta_v_deg"];
    const auto blue = surface.brdf(0, at);
    EXPECT_NEAR(blue.m[1][0] / blue.m[0][0],
                surface.fresnel(0, at.l_v).b / surface.fresnel(0, at.l_v).a,
                1e-12); // Q does not know of it
  }
}

TEST(ApparentRoughness, PolishedSharesMatchThePrintedValues) {
  // sigma = 50 nm at 60 deg: e^-g, six digits.
  Material gold = *builtin_material("paper_au");
  gold.distribution = blinn_phong(200);
  const Surface rough = compiled(gold);
  gold.apparent_roughness = ApparentRoughness{std::nullopt, 550, 50};
  const Surface polished = compiled(gold);
  // Far from the mirror direction only the rough part is left.
  const auto at = angles(60, 60, 90);
  for (const AnchorRow &row : Anchors("polished")) {
    const std::size_t b = band_of(row);
    EXPECT_NEAR(1 - polished.specular(b, at) / rough.specular(b, at), row["share"], 5.1e-7);
  }
  EXPECT_TRUE(polished.has_mirror());
}

TEST(Emission, ARoughConductorShinesLikeASmoothOneWhenItsLobeIsNarrow) {
  Material metal;
  metal.index = constant_index({25.3, 90});
  metal.distribution = blinn_phong(1e6);
  const Surface surface = compiled(metal, "nm:10000");
  for (const double theta : {10., 60.}) {
    const Emissivity rough = rough_emissivity(surface, 0, theta * degree);
    const Emissivity smooth = smooth_emissivity(surface.interface(0), std::cos(theta * degree));
    EXPECT_NEAR(rough.i, smooth.i, 2e-5);
    EXPECT_NEAR(rough.q, smooth.q, 2e-5);
  }
}

TEST(Emission, LowersTheReflectanceToOne) {
  // Kirchhoff: emissivity and albedo add to 1 in every direction; with a polarized body lobe too.
  Material paint;
  paint.index = constant_index(1.5);
  paint.distribution = {"beckmann", {{"alpha", .2}}, {}, {}};
  paint.body = BodyLobe{{{}, {.7}}, true};
  const Surface surface = compiled(paint, "nm:10000");
  for (const double theta : {5., 40., 70.})
    EXPECT_NEAR(rough_emissivity(surface, 0, theta * degree).i +
                    surface.albedo(0, tilted(std::cos(theta * degree))),
                1, 3e-4);
}

TEST(Transmission, OfAWideLobeCarriesWhatReflectionLeaves) {
  // Narrow lobe into glass: all that is not reflected goes through, int f_t cos dw = 1 - F.
  const auto d = *make_distribution({"beckmann", {{"alpha", .05}}, {}, {}});
  const double theta = 40 * degree, n = 1.5;
  const Vec3<Facet> l{std::sin(theta), 0, std::cos(theta)};
  double sum = 0, moment = 0;
  const double inside = std::asin(std::sin(theta) / n);
  constexpr int steps = 400;
  for (int a = 0; a < steps; ++a)
    for (int b = 0; b < steps; ++b) { // around the refracted direction
      const double x = -std::sin(inside) + 0.5 * ((a + 0.5) / steps - 0.5);
      const double y = 0.5 * ((b + 0.5) / steps - 0.5);
      const double z2 = 1 - x * x - y * y;
      const Vec3<Facet> v{x, y, -std::sqrt(z2)};
      const auto t = rough_transmission(*d, Shadowing::Smith, l, v, 1, n);
      const double element = 0.25 / (steps * steps); // dx dy = |cos| dw
      sum += t.f * 0.5 * (t.t_s + t.t_p) * element;
      moment += t.f * element;
    }
  const double f = Interface(n).reflection(std::cos(theta)).a;
  EXPECT_NEAR(sum, 1 - f, 2e-3); // Fresnel's change over the lobe
  EXPECT_NEAR(moment, 1, 1e-3);
}

TEST(Lobes, AllKindsAreReciprocalAndPhysical) {
  std::vector<Material> all;
  for (const auto kind :
       {Interreflection::None, Interreflection::Unpolarized, Interreflection::SingleBounceQ})
    for (const bool polarized : {false, true}) {
      Material m = *builtin_material("paper_asi");
      m.distribution = {"ggx", {{"alpha", .4}}, {}, {}};
      m.body->is_polarized = polarized;
      m.interreflection = kind;
      m.layers = {{constant_index({1.46, 0}), 120, true},
                  {constant_index({1.9, 1e-6}), 50'000, false}};
      all.push_back(m);
    }
  Material brushed = *builtin_material("paper_al");
  brushed.distribution = {"ashikhmin_shirley", {{"nu", 20}, {"nv", 300}}, {}, {}};
  all.push_back(brushed);
  for (const Material &material : all) {
    const Surface surface = compiled(material);
    for (std::uint64_t i = 0; i < 300; ++i) {
      const auto u = uniform4(9, 8, i);
      const Vec3<Facet> l = direction_from(u[0], u[1]), v = direction_from(u[2], u[3]);
      const auto there = surface.brdf(1, directions(l, v)).m,
                 back = surface.brdf(1, directions(v, l)).m;
      for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t c = 0; c < 4; ++c)
          EXPECT_NEAR(back[r][c], ((r == 2) != (c == 2) ? -1 : 1) * there[c][r],
                      1e-12 * there[0][0]);
    }
  }
}

// Total reflection lets nothing in; the rounding of 1 - a must not be light, nor more polarized
// than there is of it. Found with random materials: n = 1e-3 reflects totally beyond 0.06 deg.
TEST(BodyLight, TotalReflectionLetsNothingInAndOut) {
  Material m = *builtin_material("paper_asi");
  m.body = BodyLobe{{{}, {1.0}}, true};
  for (const double n : {1e-3, 1e-2, 0.3}) {
    m.index = constant_index(n);
    m.distribution = blinn_phong(200);
    const Surface surface = compiled(m);
    for (int i = 1; i <= 90; ++i)
      for (int o = 1; o <= 90; ++o) {
        const auto at =
            directions(tilted(std::cos(i * degree)), direction_from(std::cos(o * degree), o / 91.));
        const auto s = surface.diffuse(1, at, {1, 0, 0, 0});
        ASSERT_GE(s.i, 0) << n << " " << i << " " << o;
        ASSERT_LE(s.q * s.q + s.u * s.u, s.i * s.i * (1 + 1e-12)) << n << " " << i << " " << o;
        const double critical = std::asin(n) / degree;
        if (i > critical + 1 && o > critical + 1) { // rounding, twice, over 1 - mean reflectance
          ASSERT_LE(s.i, 1e-12) << n << " " << i << " " << o;
        }
      }
  }
}

} // namespace
} // namespace umov
