// Vega through the bands: sums over its spectrum against package synphot, and what the published
// zero points make of it.
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <umov/core/text.h>
#include <umov/io/passband_file.h>

namespace umov {
namespace {

/// Rows of a table of tests/data/bands, head and comments left out (tools/oracles/synphot_vega.py).
std::vector<std::vector<std::string>> rows_of(const char *name) {
  std::ifstream file(std::string(UMOV_SOURCE_DIR "/tests/data/bands/") + name);
  std::vector<std::vector<std::string>> out;
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> cells;
    std::istringstream words(line);
    for (std::string cell; std::getline(words, cell, ',');)
      cells.push_back(cell);
    if (!line.starts_with('#') && !cells.empty() && parse_number(cells.back()))
      out.push_back(std::move(cells));
  }
  return out;
}

Spectrum vega() {
  Spectrum out;
  for (const auto &cells : rows_of("vega_calspec.csv")) {
    out.wavelength_nm.push_back(*parse_number(cells[0]));
    out.value.push_back(*parse_number(cells[1]));
  }
  return out;
}

double magnitude_of(const char *name, MagnitudeSystem system) {
  const auto band = *find_passband(name);
  return -2.5 * std::log10(mean_in(band, vega(), "Vega")->value / *zero_irradiance(band, system));
}

TEST(Vega, IsAsSynphotHasIt) {
  const Spectrum spectrum = vega();
  const auto rows = rows_of("synphot_vega.csv");
  EXPECT_EQ(rows.size(), 24U); // all files but LSST's
  for (const auto &cells : rows) {
    const auto band = *find_passband(cells[0]);
    const double mean = mean_in(band, spectrum, "Vega")->value;
    const double ab = -2.5 * std::log10(mean / *zero_irradiance(band, MagnitudeSystem::AB));
    // Both sum by trapezoids over all points; curves that end in a step (Bessell R) feel where.
    EXPECT_NEAR(ab, *parse_number(cells[1]), 1.5e-3) << cells[0];
    EXPECT_NEAR(mean / *parse_number(cells[2]), 1, 2e-3) << cells[0];
    const double sun = -2.5 * std::log10(sunlight_in(band)->value / mean);
    EXPECT_NEAR(sun, *parse_number(cells[3]), 1e-3) << cells[0]; // a system in which Vega is 0
  }
}

TEST(Vega, HasItsPublishedMagnitudes) {
  // V of Vega is .03, and its colours are 0 (Bessell, Castelli & Plez 1998, A&A 333, 231); of
  // Gaia's bands too (Riello et al. 2021, A&A 649, A3).
  for (const char *name : {"Bessell.V", "Bessell.R", "Bessell.I"})
    EXPECT_NEAR(magnitude_of(name, MagnitudeSystem::Vega), .03, .01) << name;
  EXPECT_NEAR(magnitude_of("gaia.G", MagnitudeSystem::Vega), .03, .01);
}

/// A second program, which sums at all points of curve and spectrum, as umov does
/// (tools/oracles/speclite_ab.py --vega): six decimals are stored.
TEST(Vega, IsAsSpecliteHasIt) {
  const auto rows = rows_of("speclite_vega.csv");
  EXPECT_EQ(rows.size(), 4U);
  for (const auto &cells : rows)
    EXPECT_NEAR(magnitude_of(cells[0].c_str(), MagnitudeSystem::AB), *parse_number(cells[1]), 2e-6)
        << cells[0];
}

} // namespace
} // namespace umov
