#include "atmosphere/tests/anchor.h"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>
#include <umov/atmosphere/air.h>
#include <umov/io/passband_file.h>
#include <umov/optics/band_grid.h>

namespace umov {
namespace {

void expect_same(double found, const std::string &name) {
  EXPECT_NEAR(found, of(name), 1e-8 * std::abs(of(name))) << name;
}

TEST(Air, PressureOfTheStandardAtmosphere) {
  for (const int h : {1000, 3058, 4160})
    expect_same(standard_pressure_hpa(h), "pressure_" + std::to_string(h));
}

TEST(Air, MoleculesAfterBodhaine) {
  for (const int nm : {400, 550, 700, 900})
    expect_same(rayleigh_depth(nm, 1013.25), "rayleigh_" + std::to_string(nm));
}

TEST(Air, ExtinctionOfAHighSite) {
  Air air;
  air.pressure_hpa = standard_pressure_hpa(3058);
  for (const int nm : {425, 550, 600, 650, 850})
    expect_same(extinction_mag(nm, air), "extinction_" + std::to_string(nm));
}

TEST(Air, GasesSaturate) {
  expect_same(water_transmission(720, .3, 2), "water_720");
  expect_same(mixed_gas_transmission(760, 700, 2), "mixed_760");
  // Twice the air takes less than twice the light: the lines are full.
  const double once = -std::log(mixed_gas_transmission(760, 1013.25, 1));
  EXPECT_LT(-std::log(mixed_gas_transmission(760, 1013.25, 2)), 1.8 * once);
}

/// Sunlight of a band that arrives, summed at all points of the curve and the solar spectrum.
double arriving(const Passband &band, const Air &air, double airmass) {
  std::set<double> at(band.wavelength_nm.begin(), band.wavelength_nm.end());
  at.insert(sunlight().wavelength_nm.begin(), sunlight().wavelength_nm.end());
  Spectrum behind;
  for (const double nm : at) {
    behind.wavelength_nm.push_back(nm);
    behind.value.push_back(value_at(sunlight(), nm) * transmission(nm, air, airmass));
  }
  return mean_in(band, behind, "sunlight behind air")->value / sunlight_in(band)->value;
}

TEST(Air, TakesOfSunlightInBandsWhatItShould) {
  Air air;
  air.pressure_hpa = standard_pressure_hpa(3058);
  air.water_cm = .3;
  for (const char *name : {"Bessell.B", "Bessell.V", "Bessell.I", "gaia.G"}) {
    const Passband band = *find_passband(name);
    const BandGrid grid = *BandGrid::make(*bands_named(std::vector<std::string>{name}));
    for (const auto &[altitude, mass] :
         {std::pair{"90", 1.}, {"30", of("airmass_30")}, {"10", of("airmass_10")}}) {
      const double through = arriving(band, air, mass);
      const double expected = of(std::string("band_") + name + "_" + altitude);
      // Both are the same trapezoids: eight digits are stored.
      EXPECT_NEAR(-2.5 * std::log10(through), expected, 1e-7 * expected) << name << altitude;
      double at_nodes = 0;
      for (const BandTerm &term : grid.terms()[0])
        at_nodes += term.weight * transmission(grid.nodes()[term.node].wavelength.nm(), air, mass);
      // What light curves and counts use. Oxygen's lines, in I and G, are narrower than 10 nm.
      const bool has_lines = name == std::string("Bessell.I") || name == std::string("gaia.G");
      EXPECT_NEAR(at_nodes, through, has_lines ? 3e-3 : 2e-4) << name << altitude;
    }
  }
}

/// Median extinction over Mauna Kea by the Nearby Supernova Factory (tests/data/air/README.md).
std::vector<std::pair<double, double>> mauna_kea() {
  std::ifstream file(UMOV_SOURCE_DIR "/tests/data/air/mauna_kea_extinction.csv");
  std::vector<std::pair<double, double>> out;
  double nm = 0, mag = 0;
  char comma = 0;
  for (std::string line; std::getline(file, line);)
    if (std::istringstream cells(line); cells >> nm >> comma >> mag)
      out.emplace_back(nm, mag);
  return out;
}

TEST(Air, IsThatOverMaunaKea) {
  // One number, the aerosol, is fitted: what is left is linear in it.
  double top = 0, bottom = 0;
  Air air;
  air.pressure_hpa = standard_pressure_hpa(4160);
  air.aerosol_550 = 0;
  Air hazy = air;
  hazy.aerosol_550 = 1;
  const auto is_used = [](double nm) { return nm >= 340 && nm <= 900; };
  for (const auto &[nm, mag] : mauna_kea())
    if (is_used(nm)) {
      const double haze = extinction_mag(nm, hazy) - extinction_mag(nm, air);
      top += haze * (mag - extinction_mag(nm, air));
      bottom += haze * haze;
    }
  air.aerosol_550 = top / bottom;
  double squares = 0, count = 0;
  for (const auto &[nm, mag] : mauna_kea())
    if (is_used(nm)) {
      squares += std::pow(mag - extinction_mag(nm, air), 2);
      ++count;
    }
  EXPECT_EQ(count, 57);
  EXPECT_NEAR(air.aerosol_550, .019, .003); // Buton et al. 2013: .0076 at 1 um, exponent 1.26: .016
  EXPECT_LT(std::sqrt(squares / count), .002); // the table has three decimals
}

TEST(Air, NothingIsLostWithoutAir) {
  for (const double nm : {300., 550., 760., 2000.})
    EXPECT_EQ(transmission(nm, Air{}, 0), 1);
}

} // namespace
} // namespace umov
