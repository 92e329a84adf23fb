// Files as other writers make them, built card by card after FITS 4.0.

#include "io/table/fits_read.h"

#include <bit>
#include <cstdint>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <initializer_list>
#include <umov/core/text.h>

namespace umov {
namespace {

std::string card(std::string text) {
  text.resize(80, ' ');
  return text;
}

std::string number(const char *key, std::int64_t value) {
  return fmt::format("{:<8}= {:>20}", key, value);
}

std::string blocks(std::string bytes, char filler) {
  bytes.resize((bytes.size() + 2879) / 2880 * 2880, filler);
  return bytes;
}

/// A header of these cards, with its END.
std::string header(std::initializer_list<std::string> cards) {
  std::string out;
  for (const std::string &one : cards)
    out += card(one);
  return blocks(out + card("END"), ' ');
}

const std::string simple = "SIMPLE  =                    T";

/// A primary part without data.
std::string primary(const std::string &extra = "COMMENT nothing") {
  return header({simple, number("BITPIX", 8), number("NAXIS", 0), extra});
}

/// An image of bytes.
std::string image(std::int64_t bytes, const std::string &kind = "XTENSION= 'IMAGE   '") {
  return header({kind, number("BITPIX", 8), number("NAXIS", 1), number("NAXIS1", bytes),
                 number("PCOUNT", 0), number("GCOUNT", 1)});
}

/// Header of a table of doubles "mjd_utc" and "mag" in two rows.
std::string table_header(const std::string &extra = "COMMENT nothing", std::int64_t rows = 2) {
  return header({"XTENSION= 'BINTABLE'", number("BITPIX", 8), number("NAXIS", 2),
                 number("NAXIS1", 16), number("NAXIS2", rows), number("PCOUNT", 0),
                 number("GCOUNT", 1), number("TFIELDS", 2), "TTYPE1  = 'mjd_utc '",
                 "TFORM1  = 'D       '", "TTYPE2  = 'mag     '", "TFORM2  = 'D       '", extra});
}

/// The rows, without what fills their block.
std::string rows() {
  std::string out;
  for (const double value : {58139.25, 5.5, 58139.5, 6.25})
    for (int shift = 56; shift >= 0; shift -= 8) // the first byte is the highest
      out += static_cast<char>(std::bit_cast<std::uint64_t>(value) >> shift & 0xff);
  return out;
}

std::string table(const std::string &extra = "COMMENT nothing") {
  return table_header(extra) + blocks(rows(), '\0');
}

std::string with(std::string text, const std::string &from, const std::string &to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

void expect_rows(const std::string &bytes, const char *what) {
  const auto read = read_fits_table(bytes, "a.fits");
  ASSERT_TRUE(read) << what << ": " << read.error().text();
  ASSERT_EQ(read->rows(), 2u) << what;
  ASSERT_EQ(read->columns, (std::vector<std::string>{"mjd_utc", "mag"})) << what;
  EXPECT_EQ(parse_number(read->cell(0, 0)), 58139.25) << what;
  EXPECT_EQ(parse_number(read->cell(1, 1)), 6.25) << what;
}

TEST(FitsLayout, FormsOfOtherWritersAreRead) {
  const std::string whole = primary() + table();
  const std::string unpadded = primary() + table_header() + rows();
  const std::string ascii =
      header({"XTENSION= 'TABLE   '", number("BITPIX", 8), number("NAXIS", 2), number("NAXIS1", 16),
              number("NAXIS2", 2), number("PCOUNT", 0), number("GCOUNT", 1), number("TFIELDS", 2),
              "TTYPE1  = 'mjd_utc '", number("TBCOL1", 1), "TFORM1  = 'F8.2    '",
              "TTYPE2  = 'mag     '", number("TBCOL2", 10), "TFORM2  = 'F4.2    '"});
  const std::string groups =
      header({simple, number("BITPIX", -32), number("NAXIS", 2), number("NAXIS1", 0),
              number("NAXIS2", 700), "GROUPS  =                    T", number("PCOUNT", 20),
              number("GCOUNT", 3)});
  const std::string packed = header(
      {"XTENSION= 'BINTABLE'", number("BITPIX", 8), number("NAXIS", 2), number("NAXIS1", 8),
       number("NAXIS2", 1), number("PCOUNT", 10), number("GCOUNT", 1), number("TFIELDS", 1),
       "TTYPE1  = 'COMPRESSED_DATA'", "TFORM1  = '1PB(10) '", "ZIMAGE  =                    T",
       "ZCMPTYPE= 'RICE_1  '", number("ZBITPIX", 8), number("ZNAXIS", 1), number("ZNAXIS1", 4),
       number("ZTILE1", 4), "ZNAME1  = 'BLOCKSIZE'", number("ZVAL1", 32)});
  const std::string bare = header(
      {"XTENSION= 'IMAGE   '", number("BITPIX", 8), number("NAXIS", 1), number("NAXIS1", 12)});
  const std::string filled(2880, '\0');
  expect_rows(whole, "plain");
  expect_rows(header({simple, number("BITPIX", 8), number("NAXIS", 1), number("NAXIS1", 3000)}) +
                  filled + filled + table(),
              "image first");
  expect_rows(primary() + packed + filled + table(), "a compressed image before it");
  expect_rows(primary() + bare + filled + table(), "image without PCOUNT and GCOUNT");
  expect_rows(primary() + image(12, "XTENSION= 'IMAGE   '           / STARTABLE image") + filled +
                  table(),
              "image with TABLE in its comment");
  expect_rows(groups + blocks(std::string(3 * 720 * 4, '\0'), '\0') + table(), "random groups");
  expect_rows(primary() + ascii + blocks("58139.25 5.50   58139.50 6.25   ", ' '), "ASCII");
  expect_rows(unpadded, "without what fills the last block");
  expect_rows(unpadded + std::string(500, '\0'), "with a part of it");
  expect_rows(whole + "\n", "a line's end behind it");
  expect_rows(whole + image(1'000'000) + filled, "a later part cut");
  expect_rows(whole + image(1'000'000).substr(0, 300), "the header of a later part cut");
  expect_rows(whole + with(table_header(), "'D ", "'PD"), "a table of arrays behind it");
  for (const char *extra :
       {"OBSERVER= 'Jos\xe9 '", "COMMENT \tmade with\tflats", "HISTORY line\r\nof DOS",
        "CHECKSUM= 'aAbBcCdDeEfFgGhH'", "HIERARCH pol frame = 'altaz'", "LONGKEY = 'a&'",
        "CONTINUE  'b'", "ENDING  = 'soon'", "NAXISWCS= 'none'"}) {
    expect_rows(primary(extra) + table(), extra);
    expect_rows(primary() + table(extra), extra);
  }
  std::string nul = "OBJECT  = 'HST'";
  nul.resize(80, '\0');
  expect_rows(primary(nul) + table(), "NUL behind a value");
}

TEST(FitsLayout, OthersAreRefusedWithPartAndKeyword) {
  const std::string whole = primary() + table();
  const std::string bad = with(table(), number("TFIELDS", 2), "TFIELDS =                    x");
  const std::string shell = image(static_cast<std::int64_t>(bad.size()));
  const std::string groups = header(
      {simple, number("BITPIX", 8), number("NAXIS", 2), number("NAXIS1", 0), number("NAXIS2", 2880),
       "GROUPS  =                    T", number("PCOUNT", 0), number("GCOUNT", 1)});
  for (const auto &[bytes, words] :
       {std::pair<std::string, const char *>{
            primary() + bad, "part 2 of the FITS file has TFIELDS = \"x\", where a whole number"},
        // What hid a part from this check, and not from CFITSIO.
        {primary("     END") + shell + bad, "part 1 of the FITS file has \"END\" in its header"},
        {with(primary(), card("END"), card("END / of it")) + table(),
         "part 1 of the FITS file has \"END / of it\" in its header"},
        {groups + shell + bad, "part 2 of the FITS file has TFIELDS = \"x\""},
        {with(groups, number("NAXIS1", 0), number("NAXIS1", 1)) + table(),
         "part 1 of the FITS file has NAXIS1 = 1, where 0 was expected"},
        {with(whole, "'BINTABLE'", "'BINTABL\xc9'"),
         "part 2 of the FITS file has bytes in XTENSION"},
        {with(whole, "'D  ", "'D\t "), "part 2 of the FITS file has bytes in TFORM1"},
        {with(whole, number("NAXIS", 2), number("NAXIS", 3)),
         "part 2 of the FITS file has NAXIS = 3, where 2 was expected"},
        {with(whole, number("NAXIS2", 2), number("NAXIS2", -1)),
         "part 2 of the FITS file has NAXIS2 = -1, where 0 to "},
        {with(whole, "GCOUNT", "GCOUNX"), "part 2 of the FITS file has no GCOUNT"},
        {with(whole, number("BITPIX", 8), number("BITPIX", 7)),
         "part 1 of the FITS file has BITPIX"},
        {primary() + with(table(), card("END"), card("FIN")),
         "part 2 of the FITS file has a header without"},
        {primary() + table_header() + rows().substr(0, 31),
         "part 2 of the FITS file tells of 32 bytes of data, of which 31 are there"},
        {primary() + table_header().substr(0, 700), "part 2 of the FITS file has a header without"},
        {primary() + table_header().substr(0, 1200), "part 2 of the FITS file has no room"},
        {primary().substr(0, 100), "is shorter than a block of FITS"}}) {
    const auto read = read_fits_table(bytes, "a.fits");
    ASSERT_FALSE(read) << words;
    EXPECT_NE(read.error().text().find(words), std::string::npos) << read.error().text();
  }
}

// A cell's room is made before there is a row: 2 GB for a header of 6 KB.
TEST(FitsLayout, TextsThatNoFileHoldsAreRefused) {
  constexpr std::int64_t letters = 2'000'000'000;
  const std::string bytes =
      primary() + header({"XTENSION= 'BINTABLE'", number("BITPIX", 8), number("NAXIS", 2),
                          number("NAXIS1", letters), number("NAXIS2", 0), number("PCOUNT", 0),
                          number("GCOUNT", 1), number("TFIELDS", 1), "TTYPE1  = 'name    '",
                          "TFORM1  = '2000000000A'"});
  const auto read = read_fits_table(bytes, "a.fits");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::BadInput);
  EXPECT_NE(read.error().message.find("texts of 2000000000 letters"), std::string::npos)
      << read.error().text();
}

} // namespace
} // namespace umov
