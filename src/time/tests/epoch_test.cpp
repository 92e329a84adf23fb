#include <gtest/gtest.h>
#include <umov/time/epoch.h>
#include <umov/time/time_system.h>
#include <umov/time/typed.h>

namespace umov {
namespace {

Epoch<Utc> at(const char *iso) { return *utc_from_iso(iso); }

TEST(Epoch, ReadsAndWritesIso) {
  EXPECT_EQ(to_iso(at("2018-01-21T04:00:00Z")), "2018-01-21T04:00:00.000Z");
  EXPECT_EQ(to_iso(at("2018-01-21T04:00:00.1239Z")), "2018-01-21T04:00:00.124Z");
  EXPECT_EQ(to_iso(at("2018-01-21T04:00-10:00")), "2018-01-21T14:00:00.000Z");
  EXPECT_DOUBLE_EQ(mjd(at("2018-01-21T12:00:00Z")), 58139.5); // Julian date 2458140.0
}

TEST(Epoch, RefusesWhatIsNotATimeAndSaysWhy) {
  const struct {
    const char *text, *word;
  } rows[] = {{"2018-01-21T04:00:00", "has no zone"},
              {"2018-01-21", "2018-01-21T00:00:00Z was expected"},
              {"2018-13-21T04:00:00Z", "calendar"},
              {"2018-02-30T04:00:00Z", "calendar"},
              {"2018-01-21T25:00:00Z", "calendar"},
              {"2018-01-21T04:00:60Z", "leap second"},
              {"1971-12-31T00:00:00Z", "before 1972"},
              {"", "is not a time"},
              {"2018-01-21T04:00:00Zx", "is not a time"}};
  for (const auto &row : rows) {
    const auto result = utc_from_iso(row.text);
    ASSERT_FALSE(result) << row.text;
    EXPECT_NE(result.error().message.find(row.word), std::string::npos) << result.error().message;
  }
}

TEST(Epoch, ADayAloneIsItsBeginningWherePeopleTypeTimes) {
  EXPECT_EQ(to_iso(*utc_from_iso_or_day("2018-01-21")), "2018-01-21T00:00:00.000Z");
  EXPECT_EQ(to_iso(*utc_from_iso_or_day("2018-01-21T04:00-10:00")), "2018-01-21T14:00:00.000Z");
  for (const char *text : {"2018-02-30", "2018-1-21", "2018-01-21T04:00:00", "1971-12-31"})
    EXPECT_FALSE(utc_from_iso_or_day(text)) << text;
}

TEST(Epoch, LeapSecondIsParsedOrderedAndRoundTripped) {
  const auto before = at("2016-12-31T23:59:59Z"), leap = at("2016-12-31T23:59:60Z"),
             after = at("2017-01-01T00:00:00Z");
  EXPECT_EQ(to_iso(leap), "2016-12-31T23:59:60.000Z");
  EXPECT_NEAR(seconds_between(leap, before), 1, 1e-6);
  EXPECT_NEAR(seconds_between(after, before), 2, 1e-6);
  EXPECT_EQ(to_iso(plus_seconds(before, 1.5)), "2016-12-31T23:59:60.500Z");
}

TEST(Epoch, SplitKeepsAMicrosecond) {
  for (const char *iso : {"1972-01-01T00:00:00Z", "2018-06-30T23:59:59Z", "2056-12-31T12:00:00Z"})
    for (const double s : {1e-6, 0.001, 86399.999999, 1e6 + 1e-6})
      EXPECT_NEAR(seconds_between(plus_seconds(at(iso), s), at(iso)), s, 1e-6) << iso;
}

TEST(Epoch, ElementSetEpochs) {
  // HST's set of 2018: day 20.4 is 20 January, 09:36.
  EXPECT_EQ(to_iso(utc_from_year_day(2018, 20.4)), "2018-01-20T09:36:00.000Z");
  EXPECT_NEAR(clock_days_between(at("2018-01-21T00:00:00Z"), utc_from_year_day(2018, 20.4)), 0.6,
              1e-12);
  // The clock does not count the leap second between these.
  EXPECT_NEAR(clock_days_between(at("2017-01-01T12:00:00Z"), at("2016-12-31T12:00:00Z")), 1, 1e-12);
}

TEST(LeapSeconds, WarnPastTheTable) {
  Diagnostics quiet, warned;
  warn_if_beyond_leap_seconds(at("2026-01-01T00:00:00Z"), quiet);
  warn_if_beyond_leap_seconds(at("2040-01-01T00:00:00Z"), warned);
  EXPECT_TRUE(quiet.empty());
  EXPECT_EQ(warned.warnings().size(), 1u);
}

TEST(Calendar, RefusesWhatLeavesTheCalendarOnTheWayToUtc) { // TAI was 10 s ahead on 1972-01-01
  EXPECT_FALSE(utc_from_calendar("1972-01-01T00:00:09.9", TimeSystem::Tai));
  EXPECT_TRUE(utc_from_calendar("1972-01-01T00:00:10", TimeSystem::Tai));
  EXPECT_FALSE(utc_from_iso("1972-01-01T00:00:00+14:00"));
  EXPECT_TRUE(utc_from_iso("1972-01-01T14:00:00+14:00"));
  EXPECT_FALSE(utc_from_iso("9999-12-31T23:00:00-14:00"));
}

} // namespace
} // namespace umov
