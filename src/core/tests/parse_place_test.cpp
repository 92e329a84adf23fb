#include "core/parse_place.h"

#include <gtest/gtest.h>

namespace umov {
namespace {

TEST(LineAndColumn, CountFromOne) {
  const std::pair<std::size_t, std::size_t> begin{1, 1}, third{1, 3}, next{2, 1}, beyond{2, 3};
  EXPECT_EQ(line_and_column("ab\ncd", 0), begin);
  EXPECT_EQ(line_and_column("ab\ncd", 2), third); // the end of the line is its own last character
  EXPECT_EQ(line_and_column("ab\ncd", 3), next);
  EXPECT_EQ(line_and_column("ab\ncd", 99), beyond);
  EXPECT_EQ(line_and_column("", 0), begin);
}

TEST(JsonWords, LeaveTheNameOfTheExceptionOut) {
  EXPECT_EQ(json_words("[json.exception.out_of_range.403] key 'a' not found"), "key 'a' not found");
  EXPECT_EQ(json_words("parse error; last read: '\x1b[2J'"), "parse error; last read: '?[2J'");
}

} // namespace
} // namespace umov
