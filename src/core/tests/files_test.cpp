#include <gtest/gtest.h>
#include <umov/core/files.h>

namespace umov {
namespace {

namespace fs = std::filesystem;

TEST(Files, WritesWholeFilesAndLeavesNoTemporary) {
  const fs::path folder = fs::path(testing::TempDir()) / "umov_files_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  ASSERT_TRUE(write_file_atomically(folder / "a.txt", "one"));
  ASSERT_TRUE(write_file_atomically(folder / "a.txt", "two"));
  EXPECT_EQ(*read_file(folder / "a.txt"), "two");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST(Files, MissingInputIsBadInputAndUnwritableOutputIsDevice) {
  EXPECT_EQ(read_file("/no/such/file").error().code, ErrorCode::BadInput);
  EXPECT_EQ(read_file(testing::TempDir()).error().code, ErrorCode::BadInput);
  EXPECT_EQ(write_file_atomically("/no/such/folder/a", "x").error().code, ErrorCode::Device);
}

TEST(Files, RefusesWhatIsOverTheLimit) {
  const fs::path path = fs::path(testing::TempDir()) / "umov_limit_test";
  ASSERT_TRUE(write_file_atomically(path, std::string(100, 'x')));
  EXPECT_FALSE(read_file(path, 99));
  EXPECT_TRUE(read_file(path, 100));
}

} // namespace
} // namespace umov
