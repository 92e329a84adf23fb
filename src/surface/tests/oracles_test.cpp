// Full Mueller matrices of other programs, stored with their generators (tools/oracles).

#include "surface/tests/surface_cases.h"

#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <sstream>
#include <umov/core/text.h>

namespace umov {
namespace {

struct Row {
  std::string name;
  std::vector<double> number; ///< all cells after the first
};

std::vector<Row> rows_of(const std::string &file) {
  std::ifstream stream(std::string(UMOV_SOURCE_DIR "/tests/data/surfaces/") + file);
  std::vector<Row> out;
  bool has_header = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with('#'))
      continue;
    if (!has_header) {
      has_header = true;
      continue;
    }
    std::istringstream cells(line);
    Row row;
    std::getline(cells, row.name, ',');
    for (std::string cell; std::getline(cells, cell, ',');)
      row.number.push_back(parse_number(cell).value_or(std::nan("")));
    out.push_back(std::move(row));
  }
  return out;
}

/// Mitsuba's rational fit of Beckmann's masking over the exact one (microfacet.h of Mitsuba 3.9.1).
double fit_over_exact(double cosine, double alpha, double exact) {
  const double a = cosine / (alpha * std::sqrt(1 - cosine * cosine));
  const double fit = a >= 1.6 ? 1 : (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a);
  return fit / exact;
}

TEST(Oracles, MitsubaRoughConductorAndPlastic) {
  // tools/oracles/mitsuba_surfaces.py, Mitsuba 3.9.1, 200 geometries a case, single precision: it
  // agrees with its own formulas in double precision to 4.2e-6 of m00, hence 1e-5 here.
  const auto rows = rows_of("mitsuba_surfaces.csv");
  ASSERT_EQ(rows.size(), 1200u);
  Surface surface;
  std::string last;
  double worst = 0;
  for (const Row &row : rows) {
    const double *c = row.number.data(); // eta_n, eta_k, alpha, diffuse, angles, m00 ...
    const std::string key = row.name + shortest(c[2]);
    const bool is_plastic = row.name.starts_with("pplastic"),
               is_beckmann = row.name != "roughconductor_ggx";
    if (key != last) {
      Material material;
      material.index = constant_index({c[0], c[1]});
      material.distribution = {is_beckmann ? "beckmann" : "ggx", {{"alpha", c[2]}}, {}, {}, {}};
      material.shadowing = Shadowing::Separable;
      // Mitsuba's diffuse term has no 1/(1 - Fbar): the same lobe with that much less reflectance.
      if (is_plastic)
        material.body =
            BodyLobe{{{}, {c[3] * (1 - Interface({c[0], c[1]}).mean_reflectance())}}, true};
      surface = compiled(material, "nm:550");
      last = key;
    }
    const auto at = directions_from_angles(c[4] * degree, c[5] * degree, c[6] * degree);
    const double masking = is_beckmann ? fit_over_exact(at.l.z, c[2], surface.masking(at.l)) *
                                             fit_over_exact(at.v.z, c[2], surface.masking(at.v))
                                       : 1;
    const double w = row.name == "pplastic_diffuse_only"
                         ? 0
                         : masking * surface.specular(0, at) / (at.l.z * at.v.z);
    const auto facet = surface.mueller(0, at.l_v).m;
    for (std::size_t k = 0; k < 16; ++k) {
      const std::size_t column = k % 4;
      const Stokes<ScatteringPlane> in{column == 0 ? 1. : 0, column == 1 ? 1. : 0,
                                       column == 2 ? 1. : 0, column == 3 ? 1. : 0};
      const auto s = surface.diffuse(0, at, in);
      const double parts[4] = {s.i, s.q, s.u, s.v};
      const double ours = w * facet[k / 4][column] + parts[k / 4] / (at.l.z * at.v.z);
      worst = std::max(worst, std::abs(ours - c[7 + k]) / c[7]);
      ASSERT_NEAR(ours, c[7 + k], 1e-5 * c[7]) << key << " m" << k / 4 << column;
    }
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GT(worst, 0);
}

TEST(Oracles, ScatmechFacets) {
  // tools/oracles/scatmech_surfaces.py: Beckmann facets without shadowing, 15 digits.
  const auto rows = rows_of("scatmech_facets.csv");
  ASSERT_GT(rows.size(), 600u);
  for (const Row &row : rows) {
    const double n = *parse_number(row.name),
                 *c = row.number.data(); // eta_k, alpha, angles, m00 ...
    const auto normals = *make_distribution({"beckmann", {{"alpha", c[1]}}, {}, {}, {}});
    const auto at = directions_from_angles(c[2] * degree, c[3] * degree, c[4] * degree);
    const double w = normals->density(normalized(at.l + at.v)) / (4 * at.l.z * at.v.z);
    const auto m = Interface({n, c[0]}).reflection(std::sqrt((1 + at.l_v) / 2)).matrix().m;
    for (std::size_t k = 0; k < 16; ++k)
      ASSERT_NEAR(w * m[k / 4][k % 4], c[5 + k], 1e-11 * c[5]);
  }
}

TEST(Oracles, ScatmechFilms) {
  const std::map<std::string, Interface> stacks{
      {"sio2_on_al", Interface({1.015, 6.627}, {{1.46, 150, true}}, Wavelength::nm(550))},
      {"mgf2_on_glass", Interface(1.518, {{1.38, 550.0 / 4 / 1.38, true}}, Wavelength::nm(550))},
      {"three_on_glass",
       Interface(1.518, {{2.1, 60, true}, {1.46, 95, true}, {2.1, 60, true}}, Wavelength::nm(550))},
      {"ito_on_si", Interface({4.08, 0.028}, {{{1.9, 0.01}, 80, true}}, Wavelength::nm(550))}};
  const auto rows = rows_of("scatmech_films.csv");
  ASSERT_EQ(rows.size(), 180u);
  for (const Row &row : rows) {
    const auto f = stacks.at(row.name).reflection(std::cos(row.number[0] * degree));
    EXPECT_NEAR(f.a + f.b, row.number[1], 1e-12) << row.name << " " << row.number[0];
    EXPECT_NEAR(f.a - f.b, row.number[2], 1e-12) << row.name << " " << row.number[0];
  }
}

} // namespace
} // namespace umov
