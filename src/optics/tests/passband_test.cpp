#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <umov/optics/band.h>

namespace umov {
namespace {

Passband box() { return {"box", {500, 501, 599, 600}, {0, 1, 1, 0}, 0, "", ""}; }

TEST(Passband, EnergyCurvesAreDividedByWavelength) {
  const std::vector<double> nm{400, 500, 600};
  const auto photon = make_passband("x", nm, {0.2, 1, 0.3}, DetectorKind::Photon);
  const auto energy = make_passband("x", nm, {0.2, 1, 0.3}, DetectorKind::Energy);
  ASSERT_TRUE(photon && energy);
  const Spectrum curve{energy->wavelength_nm, energy->response};
  for (std::size_t i = 0; i < nm.size(); ++i) // by definition, but for a constant
    EXPECT_NEAR(value_at(curve, nm[i]), photon->response[i] * 500 / nm[i], 1e-15);
  // Half way between two points too, where the energy curve is linear and the other is not.
  EXPECT_NEAR(value_at(curve, 450), 0.6 * 500 / 450, 1e-15);
}

TEST(Passband, ZerosBeyondTheFirstOneAreLeftOut) {
  const auto band = make_passband("x", {1000, 1100, 1200, 1300, 1400, 1500}, {0, 0, 0.5, 1, 0, 0},
                                  DetectorKind::Photon);
  ASSERT_TRUE(band);
  EXPECT_EQ(band->wavelength_nm, (std::vector<double>{1100, 1200, 1300, 1400}));
}

TEST(Passband, RefusesWhatIsNoCurve) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto is_refused = [](std::vector<double> nm, std::vector<double> response,
                             const std::string &word) {
    const auto band = make_passband("x", std::move(nm), std::move(response), DetectorKind::Photon);
    return !band && band.error().message.find(word) != std::string::npos;
  };
  EXPECT_TRUE(is_refused({500}, {1}, "one point"));
  EXPECT_TRUE(is_refused({}, {}, "no point"));
  EXPECT_TRUE(is_refused({500, 490}, {1, 1}, "increasing"));
  EXPECT_TRUE(is_refused({500, 500}, {1, 1}, "increasing"));
  EXPECT_TRUE(is_refused({500, 600}, {1, -0.1}, "0 or more"));
  EXPECT_TRUE(is_refused({500, 600}, {1, nan}, "0 or more"));
  EXPECT_TRUE(is_refused({500, 600}, {50, 90}, "per cent"));
  EXPECT_TRUE(is_refused({500, 600}, {0, 0}, "everywhere"));
  EXPECT_TRUE(is_refused({0.5, 0.6}, {1, 1}, "micrometres"));
  EXPECT_TRUE(is_refused({-500, 600}, {1, 1}, "positive"));
}

TEST(Passband, MeanOfAFlatSpectrumIsItsValue) {
  const Spectrum flat{{100, 5000}, {3, 3}};
  const auto mean = mean_in(box(), flat, "a flat spectrum");
  ASSERT_TRUE(mean);
  EXPECT_NEAR(mean->value, 3, 1e-12);
  // Photons of a flat spectrum go with wavelength: int l^2 dl / int l dl over 500.5 to 599.5, to
  // the slopes of the flanks.
  EXPECT_NEAR(mean->effective_nm,
              (std::pow(599.5, 3) - std::pow(500.5, 3)) / 1.5 / (599.5 * 599.5 - 500.5 * 500.5),
              0.01);
  EXPECT_FALSE(mean_in(box(), {{510, 900}, {1, 1}}, "a short spectrum"));
  EXPECT_FALSE(mean_in(box(), {{100, 5000}, {0, 0}}, "darkness"));
}

TEST(Passband, ZerosOfTheSystems) {
  // 3631 Jy at 550 nm and 21.1 mag of erg s-1 cm-2 A-1: Oke & Gunn 1983, Koornneef et al. 1986.
  Passband narrow{"n", {549.99, 550, 550.01}, {0, 1, 0}, 0, "", ""};
  EXPECT_NEAR(*zero_irradiance(narrow, MagnitudeSystem::AB), 3631e-26 * 299792458e9 / (550 * 550.),
              1e-19);
  EXPECT_NEAR(*zero_irradiance(narrow, MagnitudeSystem::ST), 3.63078055e-11, 1e-19);
  const auto none = zero_irradiance(narrow, MagnitudeSystem::Vega);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("AB"), std::string::npos);
  narrow.vega_zero = 3.6e-11;
  EXPECT_EQ(*zero_irradiance(narrow, MagnitudeSystem::Vega), 3.6e-11);
}

TEST(Passband, AFilterBeforeAFilterMultiplies) {
  const Passband half = multiplied(box(), {{450, 650}, {0.5, 0.5}});
  EXPECT_NEAR(ab_zero_photons(half), ab_zero_photons(box()) / 2, 1e-12 * ab_zero_photons(box()));
  const Passband cut = multiplied(box(), {{540, 560}, {1, 1}});
  EXPECT_NEAR(pivot_nm(cut), 550, 0.5);
}

TEST(Band, OfACurveStandsAtItsEffectiveWavelength) {
  const auto band = band_of(gaussian_passband("g", 550, 80));
  ASSERT_TRUE(band);
  EXPECT_EQ(band->name, "g");
  EXPECT_NEAR(band->wavelength.nm(), 550, 3);
  const auto outside = band_of(gaussian_passband("x", 60, 80));
  ASSERT_FALSE(outside);
  EXPECT_NE(outside.error().message.find("\"x\""), std::string::npos);
  EXPECT_NE(outside.error().message.find("E490"), std::string::npos);
}

} // namespace
} // namespace umov
