// Two and three columns, as people have them.

#include <gtest/gtest.h>
#include <umov/io/index_file.h>

namespace umov {
namespace {

std::complex<double> at(const std::string &text, double nm) {
  const auto table = read_index_text(text, "mine.csv");
  EXPECT_TRUE(table) << (table ? "" : table.error().text());
  return table ? *index_at(*table, Wavelength::nm(nm)) : 0;
}

TEST(IndexColumns, SpellingsOfOneTableAreOneTable) {
  const std::complex<double> expected{1.5, 0.02}; // half way between the rows, by hand
  for (const char *text :
       {"wavelength_nm,n,k\n500,1.4,0.01\n600,1.6,0.03\n", "500 1.4 0.01\n600 1.6 0.03\n",
        "# mine\n0.5\t1.4\t0.01\n0.6\t1.6\t0.03\n",
        "Wavelength (um); n; k\r\n0.5; 1.4; 0.01\r\n0.6; 1.6; 0.03\r\n",
        "wl(\xc2\xb5m) n k\n0.5 1.4 0.01\n0.6 1.6 0.03\n",
        "angstrom,n,k\n5000,1.4,0.01\n6000,1.6,0.03\n"})
    EXPECT_NEAR(std::abs(at(text, 550) - expected), 0, 1e-12) << text;
  EXPECT_FALSE(read_index_text("500,1.4\n600,1.6\n", "n.csv")->has_k);
}

TEST(IndexColumns, RefusesWithTheLine) {
  for (const auto &[text, word] :
       {std::pair{"nm,n,k\n500,1.4,0\n600,1.4\n", "mine.csv:3: "},
        {"nm,n,k\n500,1.4,0\n600,x,0\n", "mine.csv:3: "},
        {"nm,n,k\n600,1.4,0\n500,1.4,0\n", "increasing"},
        {"x,n,k\n50,1.4,0\n500,1.4,0\n", "mine.csv:2: wavelengths 50 to 500: nm or um"},
        {"nm,n,k\n500,-1.4,0\n600,1.4,0\n", "mine.csv:2: n = -1.4"},
        {"nm,n,k\n500,1.4,0\n600,1.4,-2\n",
         "mine.csv:3: k = -2; 0 or more was expected (n + ik, k > 0 absorbs). Turn the sign"},
        {"um,n,k\n500,1.4,0\n600,1.4,0\n", "mine.csv:2: the first"},
        {"wavelength_nm,n,k\n500,x,0\n600,1,0\n", "mine.csv:2: \"x\""},
        {"nm,n,k\n500,1.5,0\n600,1.5,0\n700,1e9,0\n", "mine.csv:4: n = 1e+09"},
        {"nm,n\n500,1.5\n600,1e-9\n700,1.5\n", "mine.csv:3: n = 1e-09"},
        {"nm,n,k\n500,1.5,0\n600,1.5,1e300\n700,1.5,0\n", "mine.csv:3: k = 1e+300"},
        {"nm,n,k\n5,1.5,0\n700,1.5,0\n", "mine.csv:2: wavelength 5 nm"},
        {"nm,n,k\n500,1.4,0\n", "1 row of wavelength"},
        {"nm,n,k\n500,nan,1\n600,1,0\n", "mine.csv:2: \"nan\""},
        {"500 nan\n600 1\n700 1\n", "mine.csv:1: \"nan\""},
        {"hello\nworld\n", "wavelength, n, k"}}) {
    const auto table = read_index_text(text, "mine.csv");
    ASSERT_FALSE(table) << text;
    EXPECT_NE(table.error().text().find(word), std::string::npos) << table.error().text();
  }
}

} // namespace
} // namespace umov
