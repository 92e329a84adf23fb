// The tables of Q against phase angle (paper Fig. 16 and its shape-dependent companion).

#include "core/tests/anchors.h"
#include "surface/tests/surface_cases.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/surface/surface.h>

namespace umov {
namespace {

/// Half a unit of the fourth digit, as printed.
constexpr double printed = 0.5e-4 + 1e-9;

std::vector<Band> rgb() { return *bands_from({"paper_rgb"}); }

TEST(PaperTables, QOfEveryMaterialAndPhase) {
  const Anchors table("q_tables");
  ASSERT_EQ(table.size(), 18u);
  for (const AnchorRow &row : table) {
    const std::string &material = row.text("material");
    const bool is_sphere = material == "sphere";
    const auto surface =
        Surface::compile(*builtin_material(is_sphere ? "paper_asi" : material), rgb());
    ASSERT_TRUE(surface);
    for (int deg = 0; deg < 180; deg += 5) {
      const double phase = deg * pi / 180;
      const FresnelFactors f = is_sphere ? sphere(*surface, band_of(row), phase, 400)
                                         : surface->fresnel(band_of(row), std::cos(phase));
      // The sphere's midpoint rule adds up to 2e-6 (its change from 400 to 800 steps).
      EXPECT_NEAR(f.b / f.a, row[std::to_string(deg)], is_sphere ? printed + 2e-6 : printed)
          << material << " " << row.text("nm") << " " << deg;
    }
  }
}

TEST(PaperTables, Figures18And20AtPhase140) {
  const double c = std::cos(140 * pi / 180);
  for (const AnchorRow &row : Anchors("q_140")) { // six digits
    const auto surface = Surface::compile(*builtin_material(row.text("material")), rgb());
    const FresnelFactors f = surface->fresnel(band_of(row), c);
    EXPECT_NEAR(f.b / f.a, row["q"], 5.1e-7);
  }
}

TEST(PaperTables, DielectricsPolarizeFullyAtTwiceBrewster) {
  // alpha = 2 atan n (Brewster): Q = 1 exactly.
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
  // J 4/(R^2 F), ashikhmin; four digits.
  for (const AnchorRow &row : Anchors("rough_sphere")) {
    Material material = *builtin_material("paper_al");
    material.distribution = blinn_phong(row["m"]);
    const auto surface = Surface::compile(material, rgb());
    const double phase = row["phase_deg"] * pi / 180;
    const double j = sphere(*surface, 0, phase, 400).a / surface->fresnel(0, std::cos(phase)).a * 4;
    EXPECT_NEAR(j, row["j"], printed + 2e-5) << row["m"] << " " << phase; // + midpoint rule
  }
}

} // namespace
} // namespace umov
