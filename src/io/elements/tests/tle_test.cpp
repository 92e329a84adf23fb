// The TLE reader: one row per kind of good and bad line, made from the set in data/tle/hst.tle.

#include "orbit/tests/fixed_columns.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/files.h>
#include <umov/io/tle.h>
#include <umov/orbit/sgp4.h>

namespace umov {
namespace {

const std::string first = "1 20580U 90037B   18020.43993022  .00000491  00000-0  19169-4 0  9991";
const std::string second = "2 20580  28.4708  11.7463 0002625 356.7372 136.7243 15.08965836323135";

/// The line with `with` put over its columns from `column` (from 1) on, its checksum made right.
std::string edited(std::string line, std::size_t column, const std::string &with) {
  line.replace(column - 1, with.size(), with);
  int sum = 0;
  for (const char c : line.substr(0, 68))
    sum += c >= '0' && c <= '9' ? c - '0' : c == '-' ? 1 : 0;
  line[68] = static_cast<char>('0' + sum % 10);
  return line;
}

std::string set_of(const std::string &one, const std::string &two) {
  return one + "\n" + two + "\n";
}
std::string good() { return set_of(edited(first, 1, "1"), edited(second, 1, "2")); }
std::string with_first(std::size_t column, const std::string &with) {
  return set_of(edited(first, column, with), edited(second, 1, "2"));
}
std::string with_second(std::size_t column, const std::string &with) {
  return set_of(edited(first, 1, "1"), edited(second, column, with));
}
/// Both lines with another catalogue number.
std::string with_number(const std::string &number) {
  return set_of(edited(first, 3, number), edited(second, 3, number));
}

struct Reading {
  Result<std::vector<ElementSet>> sets;
  Diagnostics diagnostics;
};
Reading read(const std::string &text, const TleOptions &options = {}) {
  Diagnostics diagnostics;
  auto sets = read_tle(text, "a.tle", options, diagnostics);
  return {std::move(sets), std::move(diagnostics)};
}

// --- refused ---------------------------------------------------------------------------------

struct Refused {
  const char *name;
  std::string text;
  const char *place;                ///< start of the message
  std::vector<const char *> pieces; ///< found, expected, hint
};

class TleRefused : public testing::TestWithParam<Refused> {};

TEST_P(TleRefused, SaysWhereWhatAndHow) {
  const Refused &row = GetParam();
  const Reading r = read(row.text);
  ASSERT_FALSE(r.sets.has_value());
  EXPECT_EQ(r.sets.error().code, ErrorCode::BadInput);
  const std::string text = r.sets.error().text();
  EXPECT_TRUE(text.starts_with(row.place)) << text;
  for (const char *piece : row.pieces)
    EXPECT_NE(text.find(piece), std::string::npos) << piece << "\nis not in: " << text;
}

std::string without(std::string text, const std::string &what, const std::string &with) {
  text.replace(text.find(what), what.size(), with);
  return text;
}

INSTANTIATE_TEST_SUITE_P(
    Layout, TleRefused,
    testing::Values(
        Refused{"short_line",
                set_of(first.substr(0, 60), second),
                "a.tle:1:61: ",
                {"has 60 columns", "expected 69", "truncated"}},
        Refused{"length_67",
                set_of(first, second.substr(0, 67)),
                "a.tle:2:68: ",
                {"has 67 columns", "expected 69"}},
        Refused{"long_line",
                set_of(edited(first, 1, "1") + " 0.00 4320.0", second),
                "a.tle:1:70: ",
                {"columns, expected 69", "remove what stands after column 69"}},
        Refused{"wrong_checksum",
                set_of(edited(first, 1, "1"),
                       [] {
                         std::string line = edited(second, 1, "2");
                         line[68] = line[68] == '9' ? '0' : static_cast<char>(line[68] + 1);
                         return line;
                       }()),
                "a.tle:2:69: ",
                {"checksum is ", "computed ", "a character was probably changed",
                 "--allow-bad-checksum"}},
        Refused{"checksum_letter",
                set_of(first.substr(0, 68) + "x", second),
                "a.tle:1:69: ",
                {"should be a digit", "'x'"}},
        Refused{"line_number_3",
                set_of("3" + first.substr(1), second),
                "a.tle:1:1: ",
                {"line number is 3", "expected 1"}},
        Refused{"second_numbered_3",
                set_of(edited(first, 1, "1"), "3" + second.substr(1)),
                "a.tle:2:1: ",
                {"line number is 3", "expected 2"}},
        Refused{"swapped",
                set_of(second, first),
                "a.tle:1:1: ",
                {"line 2 stands without a line 1", "swapped"}},
        Refused{"first_twice",
                set_of(edited(first, 1, "1"), edited(first, 1, "1")),
                "a.tle:2:1: ",
                {"another line 1", "line 2 of the set that begins in line 1"}},
        Refused{"name_inside",
                edited(first, 1, "1") + "\nHST\n" + second,
                "a.tle:2:1: ",
                {"no element line", "expected line 2"}},
        Refused{"ends_early",
                "HST\n" + edited(first, 1, "1") + "\n",
                "a.tle:2:1: ",
                {"ends after line 1", "expected its line 2", "truncated"}},
        Refused{"only_a_name",
                good() + "ISS\n",
                "a.tle:3:1: ",
                {"the text ends after what reads as the name \"ISS\"", "expected line 1"}},
        Refused{"two_names",
                "Hello\nWorld\n" + good(),
                "a.tle:1:1: ",
                {"the name \"Hello\"", "expected line 1", "'#'"}},
        Refused{"empty", "", "a.tle: ", {"no complete element set", "TLE file?"}},
        Refused{"only_comments", "# a\n\n  # b\n", "a.tle: ", {"no complete element set"}}),
    [](const auto &row) { return row.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Characters, TleRefused,
    testing::Values(
        // A blank lost before the mean motion's derivative moves what follows to the left.
        Refused{"column_shift",
                set_of(without(first, "  .00000491", " .00000491"), second),
                "a.tle:1:35: ",
                {"column 35 should be '.'", "found '0'", "shifted"}},
        Refused{"collapsed_second",
                set_of(edited(first, 1, "1"), without(second, "20580  28", "20580 28")),
                "a.tle:2:12: ",
                {"column 12 should be '.'", "blank was probably lost"}},
        Refused{"added_blank",
                set_of("1  " + first.substr(2), second),
                "a.tle:1:9: ",
                {"column 9 should be a blank", "shifted"}},
        Refused{"leading_blank",
                set_of(" " + first, second),
                "a.tle:1:1: ",
                {"begins with a blank", "Remove"}},
        Refused{"tab",
                set_of(without(first, "   18020", "\t18020"), second),
                "a.tle:1:16: ",
                {"a tab", "fixed columns"}},
        Refused{"nbsp",
                set_of(without(first, "   18020",
                               "  \xC2\xA0"
                               "18020"),
                       second),
                "a.tle:1:18: ",
                {"non-breaking space (U+00A0)", "a plain blank", "web page"}},
        Refused{"nbsp_after_number",
                set_of("1\xC2\xA0" + first.substr(2), second),
                "a.tle:1:2: ",
                {"non-breaking space"}},
        Refused{"unicode_minus",
                set_of(without(first, "00000-0",
                               "00000\xE2\x88\x92"
                               "0"),
                       second),
                "a.tle:1:51: ",
                {"Unicode minus (U+2212)", "a plain '-'"}},
        Refused{"latin1_byte",
                set_of(without(first, "U 90", "\xB5 90"), second),
                "a.tle:1:8: ",
                {"not plain ASCII"}}),
    [](const auto &row) { return row.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Values, TleRefused,
    testing::Values(
        Refused{"other_object",
                set_of(edited(first, 1, "1"), edited(second, 3, "20581")),
                "a.tle:2:3: ",
                {"is 20581", "expected 20580", "two objects"}},
        Refused{"letter_I",
                with_number("I0000"),
                "a.tle:1:3: ",
                {"\"I0000\"", "other than I and O", "Did you mean '1'"}},
        Refused{"letter_O", with_number("O1234"), "a.tle:1:3: ", {"Did you mean '0'"}},
        Refused{"small_letter",
                with_number("a0000"),
                "a.tle:1:3: ",
                {"\"a0000\"", "a capital", "Did you mean 'A'"}},
        Refused{"small_i", with_number("i0000"), "a.tle:1:3: ", {"\"i0000\"", "Did you mean '1'"}},
        Refused{"small_l", with_number("l1234"), "a.tle:1:3: ", {"Did you mean '1'"}},
        Refused{"small_o", with_number("o1234"), "a.tle:1:3: ", {"Did you mean '0'"}},
        Refused{"word",
                with_number("abcde"),
                "a.tle:1:3: ",
                {"\"abcde\"", "a capital letter and four digits", "Fetch the set again"}},
        Refused{"word_of_capitals",
                with_number("OTHER"),
                "a.tle:1:3: ",
                {"a capital letter and four digits", "Fetch the set again"}},
        Refused{"letter_and_blank", with_number("a12 3"), "a.tle:1:3: ", {"four digits", "Fetch"}},
        Refused{"number_inside_blank",
                with_number("20 80"),
                "a.tle:1:3: ",
                {"catalogue number", "whole number"}},
        Refused{"day_0",
                with_first(21, "000.5"),
                "a.tle:1:21: ",
                {"day of year is \"000.53993022\"", "1.0 to below 366 in 2018"}},
        Refused{"day_367", with_first(21, "367.0"), "a.tle:1:21: ", {"\"367.0", "below 366"}},
        Refused{"day_367_of_leap_year",
                with_first(19, "16367.0"),
                "a.tle:1:21: ",
                {"below 367 in 2016"}},
        Refused{"inclination",
                with_second(9, "180.0001"),
                "a.tle:2:9: ",
                {"inclination is \"180.0001\"", "0 to 180 deg"}},
        Refused{"negative_angle",
                with_second(18, "-13.2018"),
                "a.tle:2:18: ",
                {"\"-13.2018\"", "0 to 360 deg", "Add 360 deg"}},
        Refused{"angle_361", with_second(44, "361.0000"), "a.tle:2:44: ", {"mean anomaly"}},
        Refused{"comma", with_second(10, "28,4708"), "a.tle:2:12: ", {"','"}},
        Refused{"blank_inclination",
                with_second(9, "   .    "),
                "a.tle:2:12: ",
                {"inclination", "0 to 180"}},
        Refused{
            "blank_in_eccentricity", with_second(27, " 00282"), "a.tle:2:28: ", {"seven digits"}},
        Refused{"mean_motion_0",
                with_second(53, " 0.00000000"),
                "a.tle:2:54: ",
                {"mean motion is \"0.00000000\"", "above 0"}},
        Refused{"drag_letters",
                with_first(54, " 1728x-4"),
                "a.tle:1:55: ",
                {"drag term", "five digits", "0.13161e-4"}},
        Refused{"sgp4_xp", with_first(63, "4"), "a.tle:1:63: ", {"ephemeris type", "SGP4-XP"}},
        Refused{"type_9", with_first(63, "9"), "a.tle:1:63: ", {"\"9\"", "expected 0"}}),
    [](const auto &row) { return row.param.name; });

TEST(TleLimits, TooLongATextIsRefusedAtOnce) {
  TleOptions options;
  options.limit_bytes = 100;
  const Reading r = read(good(), options);
  ASSERT_FALSE(r.sets.has_value());
  EXPECT_NE(r.sets.error().text().find("140 bytes, expected at most 100"), std::string::npos);
}

TEST(TleLimits, AnEndlessNameIsNoName) {
  const Reading r = read(std::string(100000, 'x'));
  ASSERT_FALSE(r.sets.has_value());
  EXPECT_TRUE(r.sets.error().text().starts_with("a.tle:1:257: the line has 100000 bytes"));
}

// --- accepted --------------------------------------------------------------------------------

ElementSet only(const std::string &text, std::size_t warnings = 0, const TleOptions &options = {}) {
  Reading r = read(text, options);
  EXPECT_TRUE(r.sets.has_value()) << (r.sets ? "" : r.sets.error().text());
  EXPECT_EQ(r.diagnostics.warnings().size(), warnings);
  if (!r.sets || r.sets->size() != 1) {
    ADD_FAILURE() << "not one set";
    return {};
  }
  return r.sets->front();
}

TEST(TleAccepted, EveryField) {
  // Values as printed in the lines at the top of this file.
  const ElementSet e = only("HST\n" + good());
  constexpr double degree = std::numbers::pi / 180;
  EXPECT_EQ(e.name, "HST");
  EXPECT_EQ(e.norad_cat_id, 20580);
  EXPECT_EQ(e.international_designator, "90037B");
  EXPECT_EQ(e.classification, 'U');
  EXPECT_EQ(e.epoch_year, 2018);
  EXPECT_DOUBLE_EQ(e.epoch_day_of_year, 20.43993022);
  EXPECT_DOUBLE_EQ(e.mean_motion_dot, 0.00000491);
  EXPECT_EQ(e.mean_motion_ddot, 0);
  EXPECT_DOUBLE_EQ(e.bstar, 0.19169e-4);
  EXPECT_EQ(e.element_number, 999);
  EXPECT_EQ(e.ephemeris_type, 0);
  EXPECT_DOUBLE_EQ(e.inclination, 28.4708 * degree);
  EXPECT_DOUBLE_EQ(e.raan, 11.7463 * degree);
  EXPECT_DOUBLE_EQ(e.eccentricity, 0.0002625);
  EXPECT_DOUBLE_EQ(e.argument_of_perigee, 356.7372 * degree);
  EXPECT_DOUBLE_EQ(e.mean_anomaly, 136.7243 * degree);
  EXPECT_DOUBLE_EQ(e.mean_motion, 15.08965836 * 2 * std::numbers::pi / 1440);
  EXPECT_EQ(e.revolution, 32313);
  EXPECT_EQ(e.line, 2u);
  EXPECT_NEAR(mjd(e.epoch), 58138.43993022, 1e-8); // MJD 58119 is 2018-01-01
}

TEST(TleAccepted, Names) {
  EXPECT_EQ(only(good()).name, "");
  EXPECT_EQ(only("0 HST\n" + good()).name, "HST");
  EXPECT_EQ(only("  HST  \n" + good()).name, "HST");
  EXPECT_EQ(only("1 ANGARA\n" + good()).name, "1 ANGARA");
  EXPECT_EQ(only("A NAME LONGER THAN TWENTY-FOUR CHARACTERS\n" + good()).name,
            "A NAME LONGER THAN TWENTY-FOUR CHARACTERS");
  EXPECT_EQ(only("\xCE\xA3 \xE6\x98\x9F\n" + good()).name, "\xCE\xA3 \xE6\x98\x9F");
  EXPECT_EQ(only("CAF\xC9\n" + good(), 1).name, "CAF?");
  EXPECT_EQ(only("A\x1B[31mB\n" + good(), 1).name, "A?[31mB");
}

TEST(TleAccepted, LineEndsAndBlanks) {
  const std::string one = edited(first, 1, "1"), two = edited(second, 1, "2");
  for (const std::string &text :
       {one + "\r\n" + two + "\r\n", one + "\r" + two + "\r", one + "\n" + two,
        "\xEF\xBB\xBF" + good(), one + "   \n" + two + " \t\n", "\n\n# note\n" + good() + "\n"})
    EXPECT_EQ(only(text).norad_cat_id, 20580);
}

TEST(TleAccepted, LinesOf68ColumnsWithAWarning) {
  const Reading r = read(set_of(first.substr(0, 68), second.substr(0, 68)));
  ASSERT_TRUE(r.sets.has_value());
  ASSERT_EQ(r.diagnostics.warnings().size(), 2u);
  EXPECT_TRUE(r.diagnostics.warnings()[1].text().starts_with(
      "a.tle:2:69: the line has 68 columns: its checksum is missing"));
}

TEST(TleAccepted, BadChecksumOnlyIfAllowed) {
  std::string two = edited(second, 1, "2");
  two[68] = two[68] == '9' ? '0' : static_cast<char>(two[68] + 1);
  TleOptions options;
  options.allow_bad_checksum = true;
  const Reading r = read(set_of(edited(first, 1, "1"), two), options);
  ASSERT_TRUE(r.sets.has_value());
  ASSERT_EQ(r.diagnostics.warnings().size(), 1u);
  EXPECT_TRUE(r.diagnostics.warnings()[0].text().starts_with("a.tle:2:69: checksum is "));
}

TEST(TleAccepted, CatalogueNumbers) {
  EXPECT_EQ(only(with_number(" 1328")).norad_cat_id, 1328);
  EXPECT_EQ(only(with_number("    5")).norad_cat_id, 5);
  EXPECT_EQ(only(with_number("00005")).norad_cat_id, 5);
  EXPECT_EQ(only(with_number("A0000")).norad_cat_id, 100000);
  EXPECT_EQ(only(with_number("J2931")).norad_cat_id, 182931);
  EXPECT_EQ(only(with_number("Z9999")).norad_cat_id, 339999);
}

TEST(TleAccepted, Epochs) {
  EXPECT_EQ(only(with_first(19, "57")).epoch_year, 1957);
  EXPECT_EQ(only(with_first(19, "56")).epoch_year, 2056);
  EXPECT_EQ(only(with_first(19, "00")).epoch_year, 2000);
  EXPECT_EQ(only(with_first(19, "16366.5")).epoch_year, 2016); // leap year: 31 December
}

TEST(TleAccepted, Day366OfACommonYearRollsOverWithAWarning) {
  const Reading r = read(with_first(21, "366.82"));
  ASSERT_TRUE(r.sets.has_value());
  EXPECT_EQ(r.sets->front().epoch_year, 2019);
  EXPECT_NEAR(r.sets->front().epoch_day_of_year, 1.82, 1e-2);
  ASSERT_EQ(r.diagnostics.warnings().size(), 1u);
  const std::string text = r.diagnostics.warnings()[0].text();
  EXPECT_TRUE(text.starts_with("a.tle:1:21: the epoch's day is 366.82")) << text;
  EXPECT_NE(text.find("2018 has 365 days"), std::string::npos) << text;
}

TEST(TleAccepted, ImpliedDecimals) {
  EXPECT_EQ(only(with_first(54, "00000+0 ")).bstar, 0);
  EXPECT_EQ(only(with_first(54, " 00000+0")).bstar, 0);
  EXPECT_EQ(only(with_first(54, " 00000-0")).bstar, 0);
  EXPECT_DOUBLE_EQ(only(with_first(54, "-12345-3")).bstar, -0.12345e-3);
  EXPECT_DOUBLE_EQ(only(with_first(54, "+12345+1")).bstar, 1.2345);
  EXPECT_DOUBLE_EQ(only(with_first(45, " 26967-3")).mean_motion_ddot, 0.26967e-3);
  EXPECT_DOUBLE_EQ(only(with_first(34, "-.00001   ")).mean_motion_dot, -0.00001);
  EXPECT_DOUBLE_EQ(only(with_first(34, "+.1       ")).mean_motion_dot, 0.1);
}

TEST(TleAccepted, AngleOf360IsZero) { EXPECT_EQ(only(with_second(18, "360.0000")).raan, 0); }

TEST(TleAccepted, ExtremeOrbitsAreLeftToSgp4) {
  EXPECT_NE(Sgp4(only(with_second(27, "9999999"))).init_code(), Sgp4Code::Ok);
  EXPECT_EQ(Sgp4(only(with_second(53, "20.00000000"))).init_code(), Sgp4Code::Decayed);
}

// --- many sets -------------------------------------------------------------------------------

TEST(TleMany, KeepGoingReportsTheBadOneAndKeepsTheRest) {
  std::string text;
  for (int i = 0; i < 100000; ++i) {
    text += "OBJECT\n";
    text += i == 50000 ? set_of(edited(first, 1, "1"), edited(second, 9, "180.0001")) : good();
  }
  EXPECT_FALSE(read(text).sets.has_value());
  TleOptions options;
  options.keep_going = true;
  const Reading r = read(text, options);
  ASSERT_TRUE(r.sets.has_value());
  EXPECT_EQ(r.sets->size(), 99999u);
  ASSERT_EQ(r.diagnostics.warnings().size(), 1u);
  EXPECT_TRUE(r.diagnostics.warnings()[0].text().starts_with(
      "a.tle:150003:9: the inclination is \"180.0001\""));
  EXPECT_TRUE(r.diagnostics.warnings()[0].text().ends_with("This set is skipped."));
}

TEST(TleMany, KeepGoingFindsTheNextSetAfterEachKindOfFault) {
  TleOptions options;
  options.keep_going = true;
  for (const std::string &bad :
       {"X\n" + set_of(edited(first, 63, "4"), edited(second, 1, "2")), // fault in line 1
        "X\n" + with_second(53, " 0.00000000"),                         // fault in line 2
        "X\n" + edited(second, 1, "2") + "\n",                          // line 1 missing
        "X\n" + edited(first, 1, "1") + "\n",                           // line 2 missing
        "3" + good().substr(1), std::string("X\n")}) {
    const Reading r = read(good() + bad + "GOOD\n" + good(), options);
    ASSERT_TRUE(r.sets.has_value()) << bad;
    ASSERT_EQ(r.sets->size(), 2u) << bad;
    EXPECT_EQ(r.sets->back().name, "GOOD");
    EXPECT_EQ(r.diagnostics.warnings().size(), 1u) << bad;
  }
}

TEST(TleMany, WarningsOfOneKindAreCapped) {
  std::string text;
  for (int i = 0; i < 150; ++i)
    text += set_of(first.substr(0, 68), second.substr(0, 68));
  const Reading r = read(text);
  ASSERT_TRUE(r.sets.has_value());
  ASSERT_EQ(r.diagnostics.warnings().size(), 101u);
  EXPECT_EQ(r.diagnostics.warnings().back().message, "200 more lines have no checksum.");
}

TEST(TleMany, AllBadIsAnErrorEvenWithKeepGoing) {
  TleOptions options;
  options.keep_going = true;
  EXPECT_FALSE(read(with_first(63, "4"), options).sets.has_value());
}

TEST(TleMany, CatalogueEqualsTheColumns) {
  // Independent of the reader: the same columns by strtod, without any check.
  const std::string path = UMOV_SOURCE_DIR "/tests/data/tle/mixed_979_2018-01-20.tle";
  const auto text = read_file(path);
  ASSERT_TRUE(text.has_value());
  const Reading r = read(*text);
  ASSERT_TRUE(r.sets.has_value()) << r.sets.error().text();
  EXPECT_TRUE(r.diagnostics.empty());
  const auto expected = test::load_by_columns(path);
  ASSERT_EQ(r.sets->size(), 979u);
  ASSERT_EQ(expected.size(), 979u);
  for (std::size_t i = 0; i < 979; ++i) {
    const ElementSet &a = (*r.sets)[i], &b = expected[i];
    EXPECT_EQ(a.norad_cat_id, b.norad_cat_id);
    EXPECT_EQ(a.epoch_year, b.epoch_year);
    for (const auto &[x, y] : {std::pair{a.epoch_day_of_year, b.epoch_day_of_year},
                               {a.bstar, b.bstar},
                               {a.inclination, b.inclination},
                               {a.raan, b.raan},
                               {a.eccentricity, b.eccentricity},
                               {a.argument_of_perigee, b.argument_of_perigee},
                               {a.mean_anomaly, b.mean_anomaly},
                               {a.mean_motion, b.mean_motion}})
      EXPECT_DOUBLE_EQ(x, y) << a.norad_cat_id; // decimal conversion: within 4 ulp
  }
}

TEST(TleMany, ShippedExamplesRead) {
  for (const auto &[file, number] : {std::pair{"hst.tle", 20580}, {"agena733.tle", 733}}) {
    const auto text = read_file(std::string(UMOV_SOURCE_DIR "/data/tle/") + file);
    ASSERT_TRUE(text.has_value());
    EXPECT_EQ(only(*text).norad_cat_id, number);
  }
}

} // namespace
} // namespace umov
