// Sentences for what is told by its number.

#include <umov/jobs/tallies.h>

#include <gtest/gtest.h>

namespace umov::jobs {
namespace {

const std::vector<Tally> two{{"frame", "with a cut", ""},
                             {"", "rows are full", "nothing but full"}};
using Texts = std::vector<std::string>;

TEST(Tallies, TellWhatThereIs) {
  EXPECT_EQ(*sentences(two, {0, 0}, 9), Texts());
  EXPECT_EQ(*sentences(two, {1, 0}, 9), Texts{"1 frame with a cut"});
  EXPECT_EQ(*sentences(two, {2, 8}, 9), (Texts{"2 frames with a cut", "8 of 9 rows are full"}));
  EXPECT_EQ(*sentences(two, {9, 0}, 9), Texts{"9 frames with a cut"}); // all, and no harm
}

TEST(Tallies, EndAJobOfWhichNothingIsLeft) {
  const auto told = sentences(two, {0, 9}, 9);
  ASSERT_FALSE(told);
  EXPECT_EQ(told.error().code, ErrorCode::Physics);
  EXPECT_EQ(told.error().message, "nothing but full");
}

TEST(Tallies, StandInAHeaderTwentyAtMost) {
  Table table;
  note_warnings(table, Texts(25, "again"));
  ASSERT_EQ(table.notes().size(), 20u);
  EXPECT_EQ(table.notes().back().first, "warning_20");
}

} // namespace
} // namespace umov::jobs
