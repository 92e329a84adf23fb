// Bands of scenarios; metals through them against a grid of a quarter nanometre (tools/anchors).

#include "core/tests/anchors.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <umov/io/index_file.h>
#include <umov/io/scenario.h>
#include <umov/shape/primitives.h>

namespace umov {
namespace {

Scene plate_of(const std::string &metal, const std::string &band) {
  Material material = *builtin_material("paper_au");
  material.name = metal;
  material.index = *find_index(metal);
  Diagnostics diagnostics;
  auto scene = make_scene(make_plate(1, 1, false), NormalMode::Flat, *bands_named({band}),
                          {material}, {material}, diagnostics);
  EXPECT_TRUE(scene) << scene.error().message;
  return std::move(*scene);
}

TEST(Bands, MetalsThroughFiltersAreRightToAThousandth) {
  std::size_t cases = 0, covered = 0;
  double worst = 0;
  for (const AnchorRow &row : Anchors("band_metals")) {
    const Scene scene = plate_of(row.text("metal"), row.text("band"));
    const double l_v = std::cos(row["phase_deg"] * pi / 180);
    const auto sum =
        sum_band<Stokes<ScatteringPlane>>(scene.grid.terms()[0], [&](std::size_t node) {
          const FresnelFactors f = scene.front[0].fresnel(node, l_v);
          return Stokes<ScatteringPlane>{f.a, f.b, 0, 0};
        });
    const double i = row["intensity"], q = row["q"];
    const double error_i = std::abs(sum.value.i - i), error_q = std::abs(sum.value.q - q * i);
    worst = std::max({worst, error_i / i, std::abs(sum.value.q / sum.value.i - q)});
    const double slack = 1e-5 * i; // a hundredth of what is asked for: there Eq. 7 may say 0
    covered +=
        error_i <= std::abs(sum.change.i) + slack && error_q <= std::abs(sum.change.q) + slack ? 1u
                                                                                               : 0u;
    ++cases;
  }
  EXPECT_EQ(cases, 60u);
  EXPECT_LE(worst, 1e-3); // docs/theory/bands.md, Eq. 8
  EXPECT_GE(static_cast<double>(covered), 0.9 * static_cast<double>(cases));
  RecordProperty("worst", std::to_string(worst));
  RecordProperty("covered", std::to_string(covered));
}

const char *const head = "umov = 1\n[[object]]\nmesh = { file = \"a.obj\", unit = \"m\", up = "
                         "\"+Z\" }\n[object.materials]\ndefault = \"paper_al\"\n[bands]\n";

std::string problem_of(const std::string &bands) {
  const auto read = read_scenario_text(head + bands, "folder/scene.toml", {});
  return read ? "" : read.error().text();
}

TEST(Bands, OfAScenario) {
  const auto read = read_scenario_text(
      std::string(head) + "set = [\"gaia\", \"bessell-V\"]\nmag_system = \"Vega\"\n", "scene.toml",
      {});
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->magnitudes, MagnitudeSystem::Vega);
  ASSERT_EQ(read->bands.size(), 4u);
  EXPECT_EQ(read->bands[3].name, "Bessell.V");
  const auto again = read_scenario_text(locked_scenario(*read), "lock.toml", {});
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(again->band_set, read->band_set);
  EXPECT_EQ(again->magnitudes, read->magnitudes);
}

TEST(Bands, BadOnesOfAScenarioNamePlaceAndMend) {
  const auto has = [](const std::string &text, const std::string &piece) {
    return text.find(piece) != std::string::npos;
  };
  EXPECT_TRUE(has(problem_of("set = \"Besell.V\"\n"), "folder/scene.toml:7:"));
  EXPECT_TRUE(has(problem_of("set = \"Besell.V\"\n"), "Did you mean \"Bessell.V\""));
  EXPECT_TRUE(has(problem_of("set = [550]\n"), "nm:550"));
  EXPECT_TRUE(has(problem_of("set = [true]\n"), "a name"));
  EXPECT_TRUE(has(problem_of("set = [{ unit = \"nm\" }]\n"), "file"));
  EXPECT_TRUE(has(problem_of("set = [{ file = \"x.csv\", unit = \"km\" }]\n"), "Angstrom"));
  EXPECT_TRUE(has(problem_of("set = [{ file = \"x.csv\", kind = \"photon\" }]\n"), "kind"));
  EXPECT_TRUE(has(problem_of("set = \"file:none.vot\"\n"), "none.vot"));
  EXPECT_TRUE(has(problem_of("set = \"nm:550\"\nmag_system = \"Vega\"\n"), "scene.toml:8:"));
  EXPECT_TRUE(has(problem_of("set = \"nm:550\"\nmag_system = \"Vega\"\n"), "AB"));
  EXPECT_TRUE(has(problem_of("mag_system = \"vega\"\n"), "Vega"));
}

} // namespace
} // namespace umov
