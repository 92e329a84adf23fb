// O2 of bands: metals through bands against a grid of a quarter nanometre (tools/anchors).

#include "core/tests/anchors.h"
#include "scene/compiled_materials.h"

#include <cmath>
#include <gtest/gtest.h>

namespace umov {
namespace {

TEST(CompiledMaterials, WavelengthsAloneAreNotTouched) {
  const auto bands = *bands_from({"paper_rgb"});
  const std::vector<Material> gold{*builtin_material("paper_au")};
  const auto made = CompiledMaterials::make(bands, gold, gold);
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->grid().is_plain());
  EXPECT_EQ(made->of(gold[0]).band_count(), 3u);
}

TEST(CompiledMaterials, PaperTablesHoldTheirEndsWithinABandOnly) {
  const std::vector<Material> gold{*builtin_material("paper_au")};
  const auto wide = CompiledMaterials::make({*band_of(gaussian_passband("wide", 425, 80))}, gold,
                                            gold); // 325 to 525 nm
  ASSERT_TRUE(wide) << wide.error().message;
  EXPECT_FALSE(CompiledMaterials::make(*bands_from({"nm:400"}), gold, gold));
}

TEST(CompiledMaterials, AGreyMaterialNeedsNoMoreWavelengths) {
  Material grey = *builtin_material("paper_au");
  grey.index = constant_index({1, 5});
  const auto made =
      CompiledMaterials::make({*band_of(gaussian_passband("g", 550, 80))}, {grey}, {grey});
  ASSERT_TRUE(made);
  EXPECT_EQ(made->grid().nodes().size(), 21u);
}

TEST(CompiledMaterials, AFilmWithFringesGetsThem) {
  Material film = *builtin_material("paper_au");
  film.index = constant_index({3.5, 0.1});
  film.layers = {{constant_index({1.45, 0}), 5000, true}}; // fringes 20 nm apart
  const auto made =
      CompiledMaterials::make({*band_of(gaussian_passband("g", 550, 80))}, {film}, {film});
  ASSERT_TRUE(made);
  EXPECT_GT(made->grid().nodes().size(), 2 * 21u);
}

} // namespace
} // namespace umov
