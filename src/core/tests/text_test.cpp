#include <gtest/gtest.h>
#include <umov/core/diagnostics.h>
#include <umov/core/text.h>
#include <vector>

namespace umov {
namespace {

TEST(ParseNumber, TakesDecimalNumbersAndNothingElse) {
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(parse_number("+.5e2"), 50);
  EXPECT_EQ(parse_number("-3."), -3);
  EXPECT_EQ(parse_number("1e-999"), 0);
  for (const char *bad : {"", "+", "-", "nan", "inf", "-inf", "0x10", "1,5", "1e999", "1.5x", "+-1",
                          " 1", "1 ", "e5"})
    EXPECT_FALSE(parse_number(bad)) << bad;
}

TEST(NearestName, FindsASlipAndKeepsQuietOtherwise) {
  const std::vector<std::string> known{"interreflection", "distribution", "body"};
  EXPECT_EQ(nearest_name("interreflecton", known), "interreflection");
  EXPECT_EQ(nearest_name("bdoy", known), "body");
  EXPECT_FALSE(nearest_name("wavelength", known));
  const std::vector<std::string> keys{"start",   "stop",      "step_s",
                                      "lat_deg", "cell_gaas", "cell_silicon"};
  EXPECT_EQ(nearest_name("step", keys), "step_s"); // by meaning, though "stop" is nearer
  EXPECT_EQ(nearest_name("lat", keys), "lat_deg");
  EXPECT_EQ(nearest_name("solar_cell", keys), "cell_gaas");
  EXPECT_EQ(nearest_name("stp", keys), "stop");
}

TEST(Sha256, MatchesThePublishedVector) {
  // FIPS 180-2, appendix B.1.
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(WhyNoText, NamesWhatTheFirstBytesAre) {
  using namespace std::string_view_literals;
  // RFC 1952 2.3.1 (gzip), PKWARE APPNOTE 4.3.7 (ZIP), Unicode 16.0 table 23-7 (byte order marks).
  for (const auto &[bytes, word] : {std::pair{"\x1F\x8B\x08 and more"sv, "gunzip"},
                                    {"PK\x03\x04"sv, "ZIP"},
                                    {"\xFF\xFEv\0"sv, "UTF-8"},
                                    {"\xFE\xFF\0v"sv, "UTF-8"},
                                    {"v 1 2\0"sv, "byte 6 is 0"}}) {
    const auto why = why_no_text(bytes);
    ASSERT_TRUE(why) << word;
    EXPECT_NE(why->find(word), std::string::npos) << *why;
  }
  for (const auto text : {""sv, "P"sv, "PK 3"sv, "\xEF\xBB\xBFname"sv, "caf\xE9"sv})
    EXPECT_FALSE(why_no_text(text)) << text;
}

TEST(Printable, KeepsUtf8AndReplacesTheRestByteByByte) {
  bool is_changed = true;
  // Two, three and four bytes: Latin, euro sign, emoji.
  for (const char *fine : {"", "HST", "caf\xC3\xA9", "\xE2\x82\xAC", "\xF0\x9F\x9B\xB0"}) {
    EXPECT_EQ(printable(fine, &is_changed), fine);
    EXPECT_FALSE(is_changed);
  }
  const std::pair<const char *, const char *> others[] = {{"caf\xE9", "caf?"},
                                                          {"\x1B[31mred", "?[31mred"},
                                                          {"a\nb", "a?b"},
                                                          {"\xC3", "?"},
                                                          {"\xC0\xAF", "??"},
                                                          {"\xE0\x80\xAF", "???"},
                                                          {"\xED\xA0\x80", "???"},
                                                          {"\xF4\x90\x80\x80", "????"},
                                                          {"\xC2\x9B"
                                                           "31m",
                                                           "?31m"},
                                                          {"\x7F", "?"}};
  for (const auto &[text, expected] : others) {
    EXPECT_EQ(printable(text, &is_changed), expected);
    EXPECT_TRUE(is_changed);
  }
}

TEST(Diagnostics, AreLimited) {
  Diagnostics diagnostics;
  for (int k = 0; k < 20'000; ++k)
    diagnostics.warn("again");
  ASSERT_EQ(diagnostics.warnings().size(), Diagnostics::most + 1);
  EXPECT_NE(diagnostics.warnings().back().message.find("left out"), std::string::npos);
}

TEST(Shortest, ReadsBackToTheSameDouble) {
  for (const double v : {0.1, 1.0 / 3, -2.5e-300, 1e22})
    EXPECT_EQ(parse_number(shortest(v)), v);
  EXPECT_EQ(shortest(std::numeric_limits<double>::quiet_NaN()), "nan");
}

TEST(CsvCells, QuotesBlanksAndColumns) { // RFC 4180, section 2
  const auto cells = csv_cells(R"(a, "b, c" ,"say ""yes""",)");
  ASSERT_TRUE(cells);
  ASSERT_EQ(cells->size(), 4u);
  EXPECT_EQ((*cells)[1].text, "b, c");
  EXPECT_EQ((*cells)[1].column, 3u);
  EXPECT_EQ((*cells)[2].text, R"(say "yes")");
  EXPECT_EQ((*cells)[3].text, "");
  EXPECT_FALSE(csv_cells("a,\"b"));
  EXPECT_EQ(csv_cells("")->size(), 1u);
}

TEST(Text, AListNamesTheFirstAndCountsTheRest) {
  const std::vector<std::string> names{"a", "b", "c", "d"};
  EXPECT_EQ(listed(names, 4), "a, b, c, d");
  EXPECT_EQ(listed(names, 2), "a, b and 2 more");
  EXPECT_EQ(listed({}, 2), "");
}

TEST(Text, LoweredChangesLettersOfAsciiAlone) {
  EXPECT_EQ(lowered("Bessell.V [NM]"), "bessell.v [nm]");
  EXPECT_EQ(lowered("\xc3\x84@[`{"), "\xc3\x84@[`{");
}

TEST(Text, PercentHasNoExponentAtAHundred) {
  EXPECT_EQ(percent(0.0123), "1.2");
  EXPECT_EQ(percent(0.453), "45");
  EXPECT_EQ(percent(0.997), "100");
}

} // namespace
} // namespace umov
