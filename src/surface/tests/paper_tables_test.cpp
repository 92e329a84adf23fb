#include "surface/tests/surface_cases.h"
// The tables of Q against phase angle (paper Fig. 16 and its shape-dependent companion).

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <umov/surface/surface.h>

namespace umov {
namespace {

/// Half a unit of the fourth digit, as printed.
constexpr double printed = 0.5e-4 + 1e-9;

std::vector<Band> rgb() { return *bands_from({"paper_rgb"}); }

struct Row {
  std::string material;
  std::size_t band = 0;
  std::vector<double> q;
};

std::vector<Row> read_rows() {
  std::ifstream file(UMOV_SOURCE_DIR "/src/surface/tests/data/q_tables.txt");
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#'))
      continue;
    std::istringstream words(line);
    Row row;
    int nm = 0;
    words >> row.material >> nm;
    row.band = nm == 425 ? 0 : nm == 550 ? 1 : 2;
    for (double q = 0; words >> q;)
      row.q.push_back(q);
    rows.push_back(row);
  }
  return rows;
}

/// I and Q of a sphere of radius 1 by quadrature over its normals: z towards the bisector, x in the
/// scattering plane; longitude and latitude measured so that the lit and seen lune is a rectangle.
FresnelFactors sphere(const Surface &surface, std::size_t band, double phase) {
  const double l_v = std::cos(phase);
  double specular = 0, body = 0;
  constexpr int steps = 400;
  const double half =
      pi / 2 - phase / 2; // longitudes -half..half from the bisector are lit and seen
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double lon = half * (2 * (i + 0.5) / steps - 1);
      const double lat = pi / 2 * (2 * (j + 0.5) / steps - 1);
      const double n_l = std::cos(lat) * std::cos(lon - phase / 2);
      const double n_v = std::cos(lat) * std::cos(lon + phase / 2);
      const double area = std::cos(lat) * (2 * half / steps) * (pi / steps);
      specular += specular_of(surface, n_l, n_v, l_v) * area;
      body += body_of(surface, band, n_l, n_v) * area;
    }
  const FresnelFactors f = surface.fresnel(band, l_v);
  return {f.a * specular + body, f.b * specular};
}

TEST(PaperTables, QOfEveryMaterialAndPhase) {
  const auto rows = read_rows();
  ASSERT_EQ(rows.size(), 18u);
  for (const Row &row : rows) {
    const bool is_sphere = row.material == "sphere";
    const auto surface =
        Surface::compile(*builtin_material(is_sphere ? "paper_asi" : row.material), rgb());
    ASSERT_TRUE(surface);
    ASSERT_EQ(row.q.size(), 36u);
    for (std::size_t i = 0; i < row.q.size(); ++i) {
      const double phase = 5.0 * static_cast<double>(i) * pi / 180;
      const FresnelFactors f = is_sphere ? sphere(*surface, row.band, phase)
                                         : surface->fresnel(row.band, std::cos(phase));
      // The sphere's midpoint rule adds up to 2e-6 (its change from 400 to 800 steps).
      EXPECT_NEAR(f.b / f.a, row.q[i], is_sphere ? printed + 2e-6 : printed)
          << row.material << " " << row.band << " " << 5 * i;
    }
  }
}

TEST(PaperTables, Figures18And20AtPhase140) {
  // physics page, section 6, six digits.
  const double c = std::cos(140 * pi / 180);
  const double au[] = {.588949, .117662, .048246}, al[] = {.082308, .098945, .115130};
  const auto gold = Surface::compile(*builtin_material("paper_au"), rgb());
  const auto aluminium = Surface::compile(*builtin_material("paper_al"), rgb());
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_NEAR(gold->fresnel(b, c).b / gold->fresnel(b, c).a, au[b], 5.1e-7);
    EXPECT_NEAR(aluminium->fresnel(b, c).b / aluminium->fresnel(b, c).a, al[b], 5.1e-7);
  }
}

TEST(PaperTables, DielectricsPolarizeFullyAtTwiceBrewster) {
  // alpha = 2 atan n (physics page, section 6): Q = 1 exactly.
  for (const char *name : {"paper_bk7", "paper_asi", "paper_mylar"}) {
    const Material material = *builtin_material(name);
    const auto surface = Surface::compile(material, rgb());
    for (std::size_t b = 0; b < 3; ++b) {
      const double alpha = 2 * std::atan(std::get<Tabulated>(material.index.n).value[b]);
      const FresnelFactors f = surface->fresnel(b, std::cos(alpha));
      EXPECT_NEAR(f.b / f.a, 1, 1e-12);
    }
  }
}

TEST(PaperTables, RoughSphere) {
  // physics page, section 7: J 4/(R^2 F), ashikhmin; four digits.
  const double phases[] = {0, 60, 90, 120, 140, 150, 160, 170};
  const struct {
    double m, j[8];
  } rows[] = {{4, {1.1914, 1.0984, .9196, .5967, .3231, .1904, .0810, .0150}},
              {10, {1.0909, 1.0846, 1.0415, .8473, .5603, .3733, .1838, .0407}},
              {50, {1.0196, 1.0196, 1.0196, 1.0167, .9641, .8450, .5892, .2087}},
              {200, {1.0050, 1.0050, 1.0050, 1.0050, 1.0049, 1.0019, .9488, .5792}},
              {1000, {1.0010, 1.0010, 1.0010, 1.0010, 1.0010, 1.0010, 1.0010, .9703}}};
  for (const auto &row : rows) {
    Material material = *builtin_material("paper_al");
    material.distribution = blinn_phong(row.m);
    const auto surface = Surface::compile(material, rgb());
    for (std::size_t i = 0; i < 8; ++i) {
      const double phase = phases[i] * pi / 180;
      const double j = sphere(*surface, 0, phase).a / surface->fresnel(0, std::cos(phase)).a * 4;
      EXPECT_NEAR(j, row.j[i], printed + 2e-5) << row.m << " " << phases[i]; // + midpoint rule
    }
  }
}

} // namespace
} // namespace umov
