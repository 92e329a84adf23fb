#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <numbers>
#include <umov/io/counts_file.h>

namespace umov {
namespace {

/// A row of an ideal analyser whose axis on the sky is at `axis_deg` (Malus), as umov reduce
/// reads it.
std::string row_of(double analyser_deg, double axis_deg, int exposure,
                   const std::string &more = "") {
  const double twice = 2 * axis_deg * std::numbers::pi / 180;
  return fmt::format("2018-01-21T05:12:{:02}Z,{},1,V,{:g}-{:g},1000,10,1,30,{},{:.4f},{:.4f}{}\n",
                     exposure, exposure, analyser_deg, axis_deg, analyser_deg, 5 * std::cos(twice),
                     5 * std::sin(twice), more.empty() ? ",0" : more);
}

constexpr const char *head =
    "time_utc,exposure,set_id,band,channel,counts,sky,sky_err,var_read,analyser_deg,w1,w2,w3";

std::vector<Warning> warnings(const std::string &columns, const std::string &rows,
                              const std::string &notes = "") {
  std::string text = notes + head + columns + ",w0\n";
  for (std::size_t at = 0, end = 0; (end = rows.find('\n', at)) != std::string::npos; at = end + 1)
    text += rows.substr(at, end - at) + ",5\n";
  Diagnostics diagnostics;
  const auto file = read_counts_text(text, "c.csv", diagnostics);
  EXPECT_TRUE(file) << file.error().text();
  return diagnostics.warnings();
}

TEST(CountsFile, AnalysersWhereTheirRowsAreSayNothing) {
  std::string mosaic, wheel;
  for (int k = 0; k < 4; ++k)
    for (const double a : {90., 45., 135., 0.}) // x axis at 30 deg + the field's turn
      mosaic += row_of(a, a + 30 + 7 * k, k);
  EXPECT_TRUE(warnings("", mosaic).empty());
  for (int k = 0; k < 4; ++k)
    wheel += row_of(45. * k, 45 * k + 30 + 7 * k, k, fmt::format(",0,{}", 30 + 7 * k));
  EXPECT_TRUE(warnings(",x_axis_pa", wheel).empty());
  // Real analysers stand a degree off.
  EXPECT_TRUE(warnings("", row_of(0, 31, 0) + row_of(45, 74, 0) + row_of(90, 120, 0)).empty());
}

TEST(CountsFile, AnalysersThatAreTakenForEachOtherAreTold) {
  std::string rows;
  for (int k = 0; k < 2; ++k)
    for (const auto &[told, real] : {std::pair{90., 90.}, {45., 135.}, {135., 45.}, {0., 0.}})
      rows += row_of(told, real + 30, k);
  const auto of_mosaic = warnings("", rows);
  ASSERT_EQ(of_mosaic.size(), 1u);
  EXPECT_EQ(of_mosaic[0].where.line, 3u);
  for (const char *words : {"analyser_deg = 45, but w1 = ", "an analyser at 135 deg",
                            "its exposure", "4 of 8 rows", "Behind a mirror"})
    EXPECT_NE(of_mosaic[0].message.find(words), std::string::npos) << of_mosaic[0].message;
  std::string wheel;
  for (int k = 0; k < 4; ++k)
    wheel += row_of(k == 2 ? 70 : 45 * k, 45 * k, k, ",0,0");
  const auto of_wheel = warnings(",x_axis_pa", wheel);
  ASSERT_EQ(of_wheel.size(), 1u);
  EXPECT_EQ(of_wheel[0].where.line, 4u);
  for (const char *words :
       {"analyser_deg = 70,", "an analyser at 90 deg", "its set", "1 of 4 rows"})
    EXPECT_NE(of_wheel[0].message.find(words), std::string::npos) << of_wheel[0].message;
  EXPECT_EQ(of_wheel[0].message.find("mirror"), std::string::npos);
}

TEST(CountsFile, WhatTurnsLightBeforeAnAnalyserIsNoContradiction) {
  std::string beams, unnamed, mirror, turning;
  for (int k = 0; k < 4; ++k) { // a half-wave plate turns the axis by twice its angle
    for (const double a : {0., 90.}) {
      beams += row_of(a, 2 * 22.5 * k - a, k, fmt::format(",0,{}", 22.5 * k));
      unnamed += row_of(a, 2 * 22.5 * k - a, k, ",0,0");
    }
    turning += row_of(0, 2 * 22.5 * k, k, ",0,0");
    mirror += row_of(45. * k, 200 - 45 * k, 0, k % 2 == 0 ? ",0" : ",.3");
  }
  EXPECT_TRUE(warnings(",plate_deg", beams).empty());
  EXPECT_TRUE(warnings(",x_axis_pa", unnamed).empty());
  EXPECT_TRUE(warnings(",x_axis_pa", turning).empty());
  EXPECT_TRUE(warnings("", mirror).empty());
  // A plate whose axis flips within the exposure has no angle: the header names it.
  const std::string flips =
      row_of(0, 0, 0) + row_of(90, 90, 0) + row_of(0, 45, 0) + row_of(90, 135, 0);
  EXPECT_TRUE(warnings("", flips, "# polarimeter: flc\n").empty());
  EXPECT_EQ(warnings("", flips, "# polarimeter: mosaic\n").size(), 1u);
}

} // namespace
} // namespace umov
