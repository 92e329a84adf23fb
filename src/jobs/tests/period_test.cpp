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

/// What a table of fluxes makes period warn of, one line each.
std::string warned(const std::string &text) {
  Diagnostics diagnostics;
  const auto file = read_observations_text(text, "faint.csv", diagnostics);
  if (!file)
    return file.error().text();
  (void)period(*file, {"", 1}, diagnostics);
  std::string out;
  for (const Warning &one : diagnostics.warnings())
    out += one.message + "\n";
  return out;
}

// Faint light in noise is often below 0, and has no magnitude.
TEST(Period, FluxesThatHaveNoMagnitudeAreCountedInAWarning) {
  std::string text = "time_utc,flux\n", bright = text;
  for (int k = 0; k < 120; ++k) {
    const double flux = 1 + 1.2 * std::sin(2 * pi * 2 * k / first_s);
    for (auto &[to, value] :
         {std::pair<std::string &, double>{text, k == 7 ? 0 : flux}, {bright, std::max(flux, 0.1)}})
      to += fmt::format("2018-01-21T05:{:02}:{:02}Z,{:.5f}\n", 2 * k / 60, 2 * k % 60, value);
  }
  // Rows whose sine is below -1/1.2, and row 7, counted apart from umov.
  int expected = 0;
  for (int k = 0; k < 120; ++k)
    expected += k == 7 || std::sin(2 * pi * 2 * k / first_s) <= -1 / 1.2 ? 1 : 0;
  EXPECT_NE(warned(text).find(fmt::format("{} rows left out: a flux of 0 or less", expected)),
            std::string::npos)
      << warned(text);
  EXPECT_EQ(warned(bright).find("left out: a flux"), std::string::npos) << warned(bright);
}

// A table of ours has both: its magnitudes are shown, and a limit, which is no brightness, would
// be the faintest of all.
TEST(Period, MagnitudesBesideFluxesAreTakenAndLimitsAreNot) {
  std::string text = "time_utc,band,I,mag,mag_limit\n";
  for (int k = 0; k < 120; ++k) {
    const double mag = 6 + 0.4 * std::sin(2 * pi * 2 * k / first_s);
    const bool is_limit = k % 10 == 3;
    text += fmt::format("2018-01-21T05:{:02}:{:02}Z,V,{:.8g},{:.5f},{}\n", 2 * k / 60, 2 * k % 60,
                        is_limit ? 1e-300 : std::pow(10, -0.4 * mag) * 4e-11, mag,
                        is_limit ? "True" : "False");
    // A band that has fluxes alone.
    text += fmt::format("2018-01-21T05:{:02}:{:02}Z,R,{:.8g},,False\n", 2 * k / 60, 2 * k % 60,
                        std::pow(10, -0.4 * mag) * 4e-11);
  }
  Diagnostics diagnostics;
  const auto file = read_observations_text(text, "ours.ecsv.csv", diagnostics);
  ASSERT_TRUE(file) << file.error().text();
  for (const char *band : {"V", "R"}) {
    const auto found = period(*file, {band, 1}, diagnostics);
    ASSERT_TRUE(found) << found.error().text();
    EXPECT_NEAR(found->number("period", 0), first_s, 0.01 * first_s * first_s / 240);
    EXPECT_GT(found->number("power", 0), 0.95);
  }
  const auto page = period_page(*file, {"V", 1});
  ASSERT_TRUE(page) << page.error().text();
  EXPECT_NE(page->find("\"y\":\"magnitude\""), std::string::npos);
  EXPECT_EQ(page->find("log of the flux"), std::string::npos);
}

/// The note "spin" of a table of two maxima in 40 s, of which every second is higher by `uneven`.
std::string said_of(double uneven) {
  std::string text = "mjd_utc,mag\n";
  for (int k = 0; k < 400; ++k) {
    const double turn = 2 * pi * k / 40.0;
    // .03 of something that looks like noise: 1 s is no part of a period of it.
    text += fmt::format("{:.12f},{:.5f}\n", 60000 + k / 86400.0,
                        7 + 0.4 * std::sin(2 * turn) + uneven * std::sin(turn) +
                            0.03 * std::sin(12.9898 * k * k));
  }
  Diagnostics diagnostics;
  const auto file = read_observations_text(text, "two.csv", diagnostics);
  const auto found = period(*file, {"", 3}, diagnostics);
  EXPECT_TRUE(found) << found.error().text();
  for (const auto &[key, said] : found ? found->notes() : Table().notes())
    if (key == "spin")
      return said;
  return "";
}

double number_after(const std::string &text, const std::string &words) {
  const std::size_t at = text.find(words);
  return at == std::string::npos ? -1 : std::stod(text.substr(at + words.size()));
}

TEST(Period, SaysWhatTheDataTellOfTwiceThePeriod) {
  const std::string uneven = said_of(0.1), even = said_of(0);
  // sin(turn) is .1 high, so that one turn of 20 s less the next is .14 in the root mean square.
  // The period to a hundredth of the width of a peak, 20^2 / 400 s: as above.
  EXPECT_NEAR(number_after(uneven, "repeats every "), 40, 0.04) << uneven;
  EXPECT_NE(uneven.find("differs by 0.14 mag"), std::string::npos) << uneven;
  EXPECT_NEAR(number_after(uneven, "The spin is "), 40, 0.04) << uneven;
  EXPECT_NEAR(number_after(even, "repeats every "), 20, 0.02) << even;
  EXPECT_NE(even.find("as noise makes them"), std::string::npos) << even;
}

TEST(Period, ThePageHasTheCurveFoldedAtBoth) {
  Diagnostics diagnostics;
  const auto file = read_observations_text(two_passes(), "two.csv", diagnostics);
  ASSERT_TRUE(file);
  const auto page = period_page(*file, {});
  ASSERT_TRUE(page) << page.error().text();
  for (const char *title : {"Brightness", "How it repeats", "do its halves differ"})
    EXPECT_NE(page->find(title), std::string::npos) << title;
  // Of the pass with the surest peak, that of more turns.
  EXPECT_NEAR(number_after(*page, "Folded at "), second_s, 0.01 * second_s * second_s / 240);
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
