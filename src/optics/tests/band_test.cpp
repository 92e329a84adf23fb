#include <gtest/gtest.h>
#include <umov/optics/band.h>

namespace umov {
namespace {

TEST(Band, ReadsTheFormsOfTheScenario) {
  const auto rgb = bands_from({"paper_rgb"});
  ASSERT_TRUE(rgb);
  EXPECT_EQ(rgb->at(1).name, "nm:550");
  EXPECT_NEAR(bands_from({"nm:432.5"})->at(0).wavelength.nm(), 432.5, 1e-9);
  for (const auto &bad : {std::vector<std::string>{},
                          {"Bessell.V"},
                          {"nm:"},
                          {"nm:x"},
                          {"nm:-5"},
                          {"nm:0.55"},
                          {"nm:550", "nm:550"}})
    EXPECT_FALSE(bands_from(bad));
}

TEST(SolarSpectrum, GivesTheTableAndRefusesOutside) {
  // A row of the standard's table: 0.5505 um, 1862 W m-2 um-1.
  const auto green = solar_irradiance(Wavelength::nm(550.5));
  ASSERT_TRUE(green);
  EXPECT_NEAR(*green, 1.862, 1e-12);
  EXPECT_FALSE(solar_irradiance(Wavelength::nm(50)));
}

} // namespace
} // namespace umov
