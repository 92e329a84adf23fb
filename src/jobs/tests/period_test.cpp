#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <umov/core/quantity.h>
#include <umov/jobs/period.h>

namespace umov::jobs {
namespace {

constexpr double first_s = 11.7, second_s = 7.3;

/// Two passes an hour apart, every two seconds; in each a sine with a period of its own.
std::string two_passes() {
  std::string out = "time_utc,band,mag\n";
  for (const auto &[minute, period] : {std::pair{0, first_s}, std::pair{60, second_s}})
    for (int k = 0; k < 120; ++k) {
      const int s = 60 * minute + 2 * k;
      out += fmt::format("2018-01-21T05:{:02}:{:02}Z,V,{:.5f}\n", s / 60 % 60, s % 60,
                         6 + 0.4 * std::sin(2 * pi * 2 * k / period));
      if (minute > 0)
        out.replace(out.rfind("T05"), 3, "T06");
    }
  return out;
}

TEST(Period, EachPassTellsItsOwn) {
  Diagnostics diagnostics;
  const auto file = read_observations_text(two_passes(), "two.csv", diagnostics);
  ASSERT_TRUE(file) << file.error().text();
  const auto found = period(*file, {"", 1}, diagnostics);
  ASSERT_TRUE(found) << found.error().text();
  ASSERT_EQ(found->rows(), 2u);
  // A grid of five values a peak and a parabola through three of them: a hundredth of the width.
  EXPECT_NEAR(found->number("period", 0), first_s, 0.01 * first_s * first_s / 240);
  EXPECT_NEAR(found->number("period", 1), second_s, 0.01 * second_s * second_s / 240);
  EXPECT_GT(found->number("power", 0), 0.95);
  EXPECT_LT(found->number("false_alarm", 0), 1e-20);
  EXPECT_EQ(found->text("time_utc", 1).substr(0, 19), "2018-01-21T06:00:00");
}

TEST(Period, RangeAndBandAreKeptTo) {
  Diagnostics diagnostics;
  const auto file = read_observations_text(two_passes(), "two.csv", diagnostics);
  ASSERT_TRUE(file);
  const auto found = period(*file, {"", 3, 0, 10}, diagnostics);
  ASSERT_TRUE(found) << found.error().text();
  for (std::size_t k = 0; k < found->rows(); ++k)
    EXPECT_LE(found->number("period", k), 10);
  const auto unknown = period(*file, {"B"}, diagnostics);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("it has V"), std::string::npos);
}

TEST(Period, TooFewRowsAreNoResult) {
  Diagnostics diagnostics;
  const auto file = read_observations_text(
      "time_utc,mag\n2018-01-21T05:00:00Z,6\n2018-01-21T05:00:10Z,7\n", "few.csv", diagnostics);
  ASSERT_TRUE(file);
  const auto found = period(*file, {}, diagnostics);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::Nothing);
}

} // namespace
} // namespace umov::jobs
