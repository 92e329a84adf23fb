#include "core/tests/anchors.h"

#include <gtest/gtest.h>
#include <umov/atmosphere/air.h>

namespace umov {
namespace {

/// Anchors have nine digits.
double of(const std::string &name) { return Anchors("observing_air").row({name.c_str()})["value"]; }
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

TEST(Air, NothingIsLostWithoutAir) {
  for (const double nm : {300., 550., 760., 2000.})
    EXPECT_EQ(transmission(nm, Air{}, 0), 1);
}

} // namespace
} // namespace umov
