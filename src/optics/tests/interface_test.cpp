#include "core/tests/anchors.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/random.h>
#include <umov/optics/interface.h>

namespace umov {
namespace {

constexpr double degree = pi / 180;
const Wavelength green = Wavelength::nm(550);
const std::complex<double> aluminium{1.015, 6.627}; // Table 1 of the paper, 550 nm

double r_s(const MuellerEntries &m) { return m.a + m.b; }
double r_p(const MuellerEntries &m) { return m.a - m.b; }

/// Both powers against a row of the table of films: six digits.
void expect_powers(const MuellerEntries &m, const char *name, const char *theta_deg) {
  const Anchors films("films");
  const AnchorRow &row = films.row({name, theta_deg});
  EXPECT_NEAR(r_s(m), row["s"], 5.1e-7) << name << " " << theta_deg;
  EXPECT_NEAR(r_p(m), row["p"], 5.1e-7) << name << " " << theta_deg;
}

TEST(Interface, QuarterWaveCoating) {
  // Closed form ((n^2 - n_s)/(n^2 + n_s))^2 (Born & Wolf 1999, section 1.6).
  const double n = 1.38, s = 1.518;
  const Interface glass(s, {{n, 550 / (4 * n), true}}, green);
  EXPECT_NEAR(glass.reflection(1).a, std::pow((n * n - s) / (n * n + s), 2), 1e-15);
  EXPECT_NEAR(glass.reflection(1).a, Anchors("films").row({"quarter_wave_mgf2"})["s"], 5e-8);
}

TEST(Interface, FilmsMatchThePrintedValues) {
  const Interface sio2(aluminium, {{1.46, 150, true}}, green);
  expect_powers(sio2.reflection(std::cos(45 * degree)), "sio2_on_al", "45");
  expect_powers(sio2.reflection(std::cos(70 * degree)), "sio2_on_al", "70");
  const Interface three(1.518, {{2.1, 60, true}, {1.46, 95, true}, {2.1, 60, true}}, green);
  expect_powers(three.reflection(std::cos(50 * degree)), "three_films", "50");
}

TEST(Interface, AFilmWithoutThicknessIsTheBareSubstrate) {
  for (double theta = 0; theta < 90; theta += 7) {
    const double c = std::cos(theta * degree);
    const MuellerEntries bare = Interface(aluminium).reflection(c);
    const MuellerEntries film = Interface(aluminium, {{1.46, 0, true}}, green).reflection(c);
    EXPECT_NEAR(film.a, bare.a, 1e-14);
    EXPECT_NEAR(film.b, bare.b, 1e-14);
    EXPECT_NEAR(std::abs(film.z - bare.z), 0, 1e-14);
  }
}

TEST(Interface, WhatIsNotReflectedEntersAClearSubstrate) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto u = uniform4(1, 2, i);
    const Interface glass(1.2 + 2 * u[0], {{1.2 + u[1], 300 * u[2], true}}, green);
    const double c = 0.01 + 0.99 * u[3];
    EXPECT_NEAR(glass.reflection(c).a + glass.transmission(c).a, 1, 1e-12);
  }
}

TEST(Interface, ThickFilmOverAMetal) {
  // n = 1.7 over aluminium with tau = .9 per pass at every angle: k chosen for each.
  const Anchors films("films");
  for (const char *theta : {"0", "60"}) {
    const AnchorRow &row = films.row({"thick_on_al", theta});
    const double c = std::cos(row["theta_deg"] * degree);
    const double inside = std::sqrt(1 - (1 - c * c) / (1.7 * 1.7));
    // tau = exp(-4 pi k d / (lambda cos)) with k so small that n counts as real.
    const double k = 1e-9, depth = -std::log(.9) * 550 * inside / (4 * pi * k);
    const Interface film(aluminium, {{{1.7, k}, depth, false}}, green);
    EXPECT_NEAR(r_s(film.reflection(c)), row["s"], 5.1e-7 + 1e-7);
    EXPECT_NEAR(r_p(film.reflection(c)), row["p"], 5.1e-7 + 1e-7);
  }
}

TEST(Interface, ThickLayersAgreeWithTheMeanOverManyThicknesses) {
  // Incoherent sums are the mean of coherent ones over a period of the thickness.
  const double c = std::cos(40 * degree);
  const Interface thick(aluminium, {{1.9, 80, true}, {1.5, 1e6, false}, {2.2, 50, true}}, green);
  double a = 0, b = 0;
  std::complex<double> z;
  constexpr int count = 400;
  const double period = 550 / (2 * std::sqrt(1.5 * 1.5 - (1 - c * c)));
  for (int i = 0; i < count; ++i) {
    const MuellerEntries m =
        Interface(aluminium,
                  {{1.9, 80, true}, {1.5, 5000 + period * i / count, true}, {2.2, 50, true}}, green)
            .reflection(c);
    a += m.a / count;
    b += m.b / count;
    z += m.z / double(count);
  }
  EXPECT_NEAR(thick.reflection(c).a, a, 1e-12);
  EXPECT_NEAR(thick.reflection(c).b, b, 1e-12);
  EXPECT_NEAR(std::abs(thick.reflection(c).z - z), 0, 1e-12);
}

TEST(Interface, MatricesStayRealisable) {
  // Eigenvalues of the coherency matrix: (a + b) and (a - b) with the cross term z: |z|^2 <=
  // a^2-b^2.
  for (std::uint64_t i = 0; i < 500; ++i) {
    const auto u = uniform4(3, 1, i), w = uniform4(3, 2, i);
    const Interface s(
        {0.3 + 3 * u[0], 5 * u[1]},
        {{{1.2 + u[2], 0.1 * u[3]}, 400 * w[0], true}, {{1.3 + w[1], 1e-4 * w[2]}, 20'000, false}},
        green);
    const MuellerEntries m = s.reflection(w[3]);
    EXPECT_LE(std::norm(m.z), (m.a * m.a - m.b * m.b) * (1 + 1e-12) + 1e-15);
    EXPECT_LE(m.a + std::abs(m.b), 1 + 1e-12);
  }
}

TEST(Slab, ClearGlassMatchesThePrintedValues) {
  const double c = std::cos(50 * degree); // BK7 at 550 nm
  const MuellerEntries r = slab_reflection(1.518, c, 1), t = slab_transmission(1.518, c, 1);
  expect_powers(r, "slab_reflects", "50");
  expect_powers(t, "slab_transmits", "50");
}

TEST(Interface, MeanReflectanceMatchesThePrintedValues) {
  for (const AnchorRow &row : Anchors("table1")) // six digits
    EXPECT_NEAR(Interface({row["n"], row["k"]}).mean_reflectance(), row["f_mean"], 5.1e-7)
        << row.text("material") << " " << row.text("nm");
}

} // namespace
} // namespace umov
