#include <algorithm>
#include <gtest/gtest.h>
#include <umov/optics/band_grid.h>

namespace umov {
namespace {

std::vector<Band> two_curves() {
  return {*band_of(gaussian_passband("a", 550, 80)), *band_of(gaussian_passband("b", 600, 80))};
}

TEST(BandGrid, WavelengthsAloneStayWhatTheyAre) {
  const auto bands = *bands_from({"paper_rgb"});
  const auto grid = BandGrid::make(bands);
  ASSERT_TRUE(grid);
  EXPECT_TRUE(grid->is_plain());
  ASSERT_EQ(grid->nodes().size(), 3u);
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_EQ(grid->nodes()[b].name, bands[b].name);
    ASSERT_EQ(grid->terms()[b].size(), 1u);
    EXPECT_EQ(grid->terms()[b][0].weight, 1);
    EXPECT_EQ(grid->terms()[b][0].coarse, 1);
  }
}

TEST(BandGrid, WeightsGiveTheMeanOfWhatIsLinear) {
  // A hat rule is exact for a linear function: its mean is the effective wavelength.
  const auto bands = two_curves();
  for (const double step : {20., 10., 5.}) {
    const auto grid = BandGrid::make(bands, {step, step});
    ASSERT_TRUE(grid);
    EXPECT_FALSE(grid->is_plain());
    for (std::size_t b = 0; b < 2; ++b) {
      double sum = 0, mean = 0, coarse_sum = 0, coarse_mean = 0;
      for (const BandTerm &term : grid->terms()[b]) {
        const double nm = grid->nodes()[term.node].wavelength.nm();
        sum += term.weight, coarse_sum += term.coarse;
        mean += term.weight * nm, coarse_mean += term.coarse * nm;
      }
      // Rounding of some hundred terms; the grid's own points make the trapezoids finer.
      EXPECT_NEAR(sum, 1, 1e-12);
      EXPECT_NEAR(coarse_sum, 1, 1e-12);
      EXPECT_NEAR(mean, bands[b].wavelength.nm(), 1e-3);
      EXPECT_NEAR(coarse_mean, bands[b].wavelength.nm(), 1e-3);
    }
  }
}

TEST(BandGrid, BandsShareTheirWavelengths) {
  const auto bands = two_curves(); // 450-650 and 500-700 nm: 21 nodes each, 16 of them in common
  const auto grid = BandGrid::make(bands);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->terms()[0].size(), 21u);
  EXPECT_EQ(grid->terms()[1].size(), 21u);
  EXPECT_EQ(grid->nodes().size(), 26u);
}

TEST(BandGrid, TheFirstWavelengthIsTheHeaviestOfTheFirstBand) {
  const auto grid = BandGrid::make(two_curves());
  ASSERT_TRUE(grid);
  const auto &terms = grid->terms()[0];
  const auto heaviest = std::ranges::max_element(terms, {}, &BandTerm::weight);
  EXPECT_EQ(heaviest->node, 0u);
}

TEST(BandGrid, CurvesAndWavelengthsGoTogether) {
  std::vector<Band> bands = *bands_from({"nm:550"});
  bands.push_back(two_curves()[0]);
  const auto grid = BandGrid::make(bands);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->terms()[0].size(), 1u);
  EXPECT_EQ(grid->nodes()[0].name, "nm:550");
  EXPECT_EQ(grid->nodes().size(), 22u); // its own 550 nm holds ends of tables, nm:550 does not
}

TEST(BandGrid, RefusesABandOfTooManyWavelengths) {
  const Band wide = *band_of({"wide", {500, 600, 20'000}, {0, 1, 0}, 0, "", ""});
  const auto grid = BandGrid::make({wide});
  ASSERT_FALSE(grid);
  EXPECT_NE(grid.error().message.find("\"wide\""), std::string::npos);
}

} // namespace
} // namespace umov
