#include "io/table/row_texts.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <umov/io/poses_file.h>
#include <umov/io/table.h>

namespace umov {
namespace {

Table sample() {
  Table table;
  table.add("x", "m2 / sr", "an area", std::vector<double>{0.1, std::nan(""), 1e22});
  table.add("n", "", "a count", std::vector<std::int64_t>{1, -2, 3});
  table.add("name", "", "a text", std::vector<std::string>{"a", "b, \"c\"", ""});
  table.add("flag", "", "yes or no", std::vector<bool>{true, false, true});
  table.note("object", "HST");
  return table;
}

TEST(Table, CsvCarriesUnitsAndLeavesUndefinedCellsEmpty) {
  const std::string csv = to_csv(sample());
  EXPECT_NE(csv.find("# unit: "), std::string::npos);
  EXPECT_NE(csv.find("m2 / sr"), std::string::npos);
  EXPECT_NE(csv.find("\"b, \"\"c\"\"\""), std::string::npos) << csv;
  EXPECT_NE(csv.find("\n,-2,"), std::string::npos) << csv;
}

TEST(Table, CsvHasNoFormulas) {
  Table table;
  table.add("name", "", "",
            std::vector<std::string>{"=1+1", "@SUM(A1)", "+cmd|' /C calc'!A0", "-HYPERLINK(\"x\")",
                                     "+X", "-2 deg", "a=1"});
  EXPECT_EQ(to_csv(table), "# unit: \nname\n'=1+1\n'@SUM(A1)\n\"'+cmd|' /C calc'!A0\"\n"
                           "\"'-HYPERLINK(\"\"x\"\")\"\n+X\n\"-2 deg\"\na=1\n");
}

TEST(Poses, HaveWholeNumbers) {
  const std::string header = "pose,sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n";
  const auto fine =
      read_poses(header + "7,1,0,0,0,2,0\n7,1,0,0,0,1,0\n-9,5e-324,0,0,0,0,1e308\n", "p.csv");
  ASSERT_TRUE(fine) << fine.error().text();
  EXPECT_EQ(fine->number, (std::vector<std::int64_t>{7, -9}));
  EXPECT_EQ(norm(fine->poses[1].sun), 1);
  for (const char *number : {"1e30", "0.5", "-1e19"}) {
    const auto bad = read_poses(header + number + ",1,0,0,0,1,0\n", "p.csv");
    ASSERT_FALSE(bad) << number;
    EXPECT_EQ(bad.error().where.line, 2u);
    EXPECT_NE(bad.error().message.find("whole number"), std::string::npos);
  }
}

TEST(Table, NumbersReadBackBitForBit) {
  const auto back = read_csv(to_csv(sample()), "t.csv", {"n"});
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ(back->rows(), 3u);
  EXPECT_EQ(back->number("n", 1), -2);
  Table numbers;
  numbers.add("x", "", "", std::vector<double>{1.0 / 3, 5e-324, -1.7976931348623157e308});
  const auto again = read_csv(to_csv(numbers), "t.csv", {"x"});
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(again->number("x", 0), 1.0 / 3);
  EXPECT_EQ(again->number("x", 2), -1.7976931348623157e308);
}

/// A cell that is as the one above it takes its text from there: alone it has none to take.
TEST(Table, RowsAreTheSameWhateverStandsAboveThem) {
  const double nan = std::nan("");
  Table table;
  table.add("x", "", "", std::vector<double>{1. / 3, 1. / 3, 1. / 3, 0, -0., -0., nan, nan});
  table.add("x_err", "", "", std::vector<double>{.01, .01, .1, .1, .1, .1, .1, .1});
  table.add("n", "", "", std::vector<std::int64_t>{-5, -5, 7, 7, 7, 7, 1'000'000, 1'000'000});
  table.add("name", "", "",
            std::vector<std::string>{"=a b", "=a b", "#", "", "", "c", "c", "d\"e"});
  table.add("flag", "", "", std::vector<bool>{true, true, false, false, true, true, true, true});
  table.set_precision("x", {"x_err", 0, 0});
  for (const TextForm form : {TextForm::Csv, TextForm::Ecsv}) {
    std::string whole, alone;
    append_rows(table, 0, table.rows(), form, whole);
    for (std::size_t row = 0; row < table.rows(); ++row)
      append_rows(table, row, row + 1, form, alone);
    EXPECT_EQ(whole, alone);
  }
  std::string csv;
  append_csv_rows(table, 1, 5, csv);
  EXPECT_EQ(csv, "0.333,0.01,-5,\"'=a b\",True\n0.33,0.1,7,\"#\",False\n0,0.1,7,,False\n"
                 "-0,0.1,7,,True\n");
}

TEST(Table, MoreDigitsThanADoubleHasAreAllOfThem) {
  for (const int significant : {17, 40, 1000}) {
    Table table; // what another number left behind is no digit of it
    table.add("a", "", "", std::vector<double>{2. / 3});
    table.add("x", "", "", std::vector<double>{1. / 3});
    table.set_precision("a", {"", 0, 16});
    table.set_precision("x", {"", 0, significant});
    std::string csv;
    append_csv_rows(table, 0, 1, csv);
    EXPECT_EQ(csv, "0.6666666666666666,0.3333333333333333\n") << significant;
  }
}

TEST(Table, JsonHasNullForUndefined) {
  const auto json = nlohmann::json::parse(to_json(sample()));
  ASSERT_EQ(json.size(), 3u);
  EXPECT_TRUE(json[1]["x"].is_null());
  EXPECT_EQ(json[0]["flag"], true);
}

TEST(ReadCsv, CountsCellsBeforeItMakesThem) {
  const auto table = read_csv("a,b\n" + std::string(1'000'000, ',') + "\n", "t.csv", {"a"}, {});
  ASSERT_FALSE(table);
  EXPECT_NE(table.error().text().find("t.csv:2: more than 10000 cells"), std::string::npos);
}

TEST(ReadCsv, SaysWhatIsWrongWhere) {
  const struct {
    const char *text;
    std::size_t line;
  } rows[] = {{"a,b\n1,2\n", 1}, {"x,y\n1,2\n3\n", 3}, {"x,y\n1,zwei\n", 2}, {"x,y\n1,nan\n", 2}};
  for (const auto &row : rows) {
    const auto result = read_csv(row.text, "t.csv", {"x", "y"});
    ASSERT_FALSE(result) << row.text;
    EXPECT_EQ(result.error().where.line, row.line) << result.error().text();
  }
  for (const auto &[text, word] :
       {std::pair{"x;y\n1;2\n", "semicolons"}, {"1,2\n", "names of the columns were expected"}}) {
    const auto result = read_csv(text, "t.csv", {"x", "y"});
    ASSERT_FALSE(result) << text;
    EXPECT_NE(result.error().text().find(word), std::string::npos) << result.error().text();
    EXPECT_EQ(result.error().where.line, 1u);
  }
  EXPECT_FALSE(read_csv("", "t.csv", {"x"}));
  EXPECT_TRUE(read_csv("# c\n\nz,x\nfoo,1\n", "t.csv", {"x"}));
}

} // namespace
} // namespace umov
