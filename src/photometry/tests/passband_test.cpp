#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <umov/photometry/passband.h>

namespace umov {
namespace {

TEST(Passband, GaussianHasItsWidth) {
  const Passband band = gaussian_passband("g", 550, 80);
  for (std::size_t i = 0; i < band.wavelength_nm.size(); ++i)
    if (std::abs(std::abs(band.wavelength_nm[i] - 550) - 40) < 1e-9) {
      EXPECT_NEAR(band.response[i], 0.5, 1e-12);
    }
  EXPECT_EQ(band.response[50], 1);
}

TEST(Passband, WeightsAreOfDetectedPhotons) {
  const Passband band = gaussian_passband("g", 550, 80);
  const auto weights = sunlight_weights(band);
  ASSERT_TRUE(weights);
  EXPECT_NEAR(std::accumulate(weights->begin(), weights->end(), 0.), 1, 1e-12);
  // Sunlight is nearly flat in photons there: within 3 nm of the centre.
  EXPECT_NEAR(mean_wavelength_nm(band, *weights), 550, 3);
}

TEST(Passband, OutsideTheSolarTableIsSaid) {
  EXPECT_FALSE(sunlight_weights(gaussian_passband("x", 60, 80)));
}

// Froehlich & Shaw 1980 (Appl. Opt. 19, 1773) and Bucholtz 1995 (Appl. Opt. 34, 2765, Table 3) give
// 0.0971 to 0.0978 at 550 nm and 0.36 at 400 nm at sea level: within 1.5 %.
TEST(Passband, RayleighExtinctionAtSeaLevel) {
  const double mag = 2.5 / std::log(10.);
  EXPECT_NEAR(clear_extinction_mag(550, 1013.25, 0) / mag, 0.0973, 0.0015);
  EXPECT_NEAR(clear_extinction_mag(400, 1013.25, 0) / mag, 0.361, 0.005);
  EXPECT_NEAR(clear_extinction_mag(550, 0, 0.1) / mag, 0.1, 1e-12);
}

} // namespace
} // namespace umov
