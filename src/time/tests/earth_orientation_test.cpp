// UT1-UTC and polar motion: the compiled-in table, tables that are given, tables that are none.

#include <gtest/gtest.h>
#include <umov/time/earth_orientation.h>

namespace umov {
namespace {

Epoch<Utc> utc(const char *iso) { return utc_from_iso(iso).value(); }
constexpr double arcsec_per_rad = 206264.806247;

TEST(EarthOrientation, GivesTheIersTable) {
  // finals2000A, MJD 60309 (2023-12-31): x .138971, y .201880 arcsec, UT1-UTC .0089604 s.
  const EarthOrientation eo = earth_orientation(utc("2023-12-31T00:00:00Z"));
  EXPECT_TRUE(eo.is_covered);
  EXPECT_NEAR(eo.dut1_s, .0089604, 1e-12);
  EXPECT_NEAR(eo.x_p_rad * arcsec_per_rad, .138971, 1e-9);
  // Up to the leap second at the end of 2016 UT1-UTC stays near -.41; after it, near +.59.
  EXPECT_LT(earth_orientation(utc("2016-12-31T23:59:00Z")).dut1_s, -0.4);
  EXPECT_GT(earth_orientation(utc("2017-01-01T00:00:00Z")).dut1_s, 0.5);
  EXPECT_FALSE(earth_orientation(utc("1972-07-01T00:00:00Z")).is_covered);
}

TEST(EarthOrientation, HoldsTheLastDayAndSaysByHowMuchThatMayBeOff) {
  const EarthOrientationTable table = earth_orientation_table();
  const auto later = plus_seconds(table.last, 100 * 86400.0);
  EXPECT_FALSE(earth_orientation(later).is_covered);
  EXPECT_EQ(earth_orientation(later).dut1_s, earth_orientation(table.last).dut1_s);
  Diagnostics none, warned;
  warn_if_outside_eop(utc("1995-01-01T00:00:00Z"), table.last, none);
  EXPECT_TRUE(none.empty());
  warn_if_outside_eop(table.last, later, warned);
  ASSERT_EQ(warned.warnings().size(), 1u);
  // 100 days of at most 3 ms; the equator moves by 465.1 m/s.
  const std::string text = warned.warnings()[0].message;
  EXPECT_NE(text.find("0.3 s or 140 m"), std::string::npos) << text;
}

/// Puts the compiled-in table back.
class OtherEarth : public testing::Test {
protected:
  void TearDown() override { use_built_in_earth_orientation(); }
};

TEST_F(OtherEarth, IsReadFromFinals2000AWithItsPredictions) {
  // Lines of IERS finals2000A.all: 2016-12-31, 2017-01-01 (measured; a leap second between them)
  // and one of which the flag of UT1 is set to predicted.
  const char *const text =
      "161231 57753.00 I  0.081400 0.000052  0.263094 0.000039  I-0.4077601 0.0000078\n"
      "17 1 1 57754.00 I  0.080504 0.000028  0.263145 0.000028  I 0.5912821 0.0000077\n"
      "17 1 2 57755.00 P  0.080285 0.000029  0.263605 0.000032  P 0.5901752 0.0000063\n"
      "17 1 3 57756.00 \n";
  ASSERT_TRUE(use_earth_orientation(text, "finals"));
  const EarthOrientationTable table = earth_orientation_table();
  EXPECT_EQ(table.name, "finals");
  EXPECT_EQ(to_iso(table.last), "2017-01-02T00:00:00.000Z");
  EXPECT_EQ(to_iso(table.measured_last), "2017-01-01T00:00:00.000Z");
  // Half of the day before the leap second: -.4077601 + (.5912821 - 1 + .4077601) / 2.
  EXPECT_NEAR(earth_orientation(utc("2016-12-31T12:00:00Z")).dut1_s, -0.408239, 1e-6);
  EXPECT_NEAR(earth_orientation(utc("2017-01-01T12:00:00Z")).y_p_rad * arcsec_per_rad, 0.263375,
              1e-9);
}

TEST_F(OtherEarth, AtItsLastMidnightALeapSecondHasBeen) {
  // The first two of the lines above: the table ends as the leap second does.
  ASSERT_TRUE(use_earth_orientation("57753,0.081400,0.263094,-0.4077601\n"
                                    "57754,0.080504,0.263145,0.5912821\n",
                                    "finals"));
  EXPECT_EQ(earth_orientation(utc("2017-01-01T00:00:00Z")).dut1_s, 0.5912821);
  EXPECT_TRUE(earth_orientation(utc("2017-01-01T00:00:00Z")).is_covered);
  EXPECT_FALSE(earth_orientation(utc("2017-01-01T00:00:01Z")).is_covered);
}

TEST_F(OtherEarth, IsReadFromColumns) {
  ASSERT_TRUE(use_earth_orientation("# by hand\nmjd,x_arcsec,y_arcsec,ut1_utc_s\r\n"
                                    "60000,0.1,0.2,-0.01\r\n60001,0.1,0.2,-0.03\r\n",
                                    "columns"));
  EXPECT_NEAR(earth_orientation({2400000.5, 60000.25}).dut1_s, -0.015, 1e-9);
  EXPECT_EQ(mjd(earth_orientation_table().measured_last), 60001);
}

TEST_F(OtherEarth, RefusesWhatIsNoTableAndKeepsTheOldOne) {
  const struct {
    const char *text;
    std::size_t line;
  } rows[] = {
      {"", 1},
      {"hello", 1},
      {"60000,0.1,0.2,-0.01\n", 1},                   // one day
      {"60000,0.1,0.2,0\n60002,0.1,0.2,0\n", 2},      // a day is missing
      {"60000,0.1,0.2,0\n60001,0.1,0.2,5\n", 2},      // no UT1-UTC
      {"60000,0.1,0.2,0\n60001,0.1,0.2,.6\n", 2},     // neither a day's change nor a leap second
      {"60000,0.1,0.2,-.98\n60001,0.1,0.2,.98\n", 2}, // two leap seconds at once
      {"60000,0.1,0.2,0\n60001,0.1,x,0\n", 2},        // no number
      {"60000,0.1,0.2,0\n60001,0.1\n", 2}};           // too few
  for (const auto &row : rows) {
    const auto done = use_earth_orientation(row.text, "bad");
    ASSERT_FALSE(done) << row.text;
    EXPECT_EQ(done.error().code, ErrorCode::BadInput);
    EXPECT_EQ(done.error().where.line, row.line) << row.text;
    EXPECT_NE(earth_orientation_table().name, "bad");
  }
}

} // namespace
} // namespace umov
