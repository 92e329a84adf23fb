#include <gtest/gtest.h>
#include <umov/core/files.h>
#include <umov/io/run_folder.h>

namespace umov {
namespace {

namespace fs = std::filesystem;

class RunFolderTest : public testing::Test {
protected:
  void SetUp() override {
    base_ =
        fs::path(testing::TempDir()) /
        (std::string("umov_run_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(base_);
    fs::create_directories(base_);
  }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(base_), fs::directory_iterator()));
  }
  fs::path base_;
};

TEST_F(RunFolderTest, ReplacesItsOwnFolderAsAWhole) {
  for (const char *round : {"first", "second"}) {
    auto folder = RunFolder::open(base_ / "deep/out", false);
    ASSERT_TRUE(folder) << folder.error().text();
    folder->add("manifest.json", make_manifest({}));
    folder->add(round == std::string("first") ? "lightcurve.csv" : "lightcurve.ecsv", round);
    ASSERT_TRUE(folder->commit());
  }
  EXPECT_FALSE(fs::exists(base_ / "deep/out/lightcurve.csv"));
  EXPECT_EQ(*read_file(base_ / "deep/out/lightcurve.ecsv"), "second");
  EXPECT_EQ(std::distance(fs::directory_iterator(base_ / "deep"), fs::directory_iterator()), 1);
}

TEST_F(RunFolderTest, LeavesAForeignFolderAlone) {
  ASSERT_TRUE(write_file_atomically(base_ / "thesis.tex", "mine"));
  const auto refused = RunFolder::open(base_, false);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Device);
  EXPECT_NE(refused.error().message.find("--force"), std::string::npos);
  auto forced = RunFolder::open(base_, true);
  ASSERT_TRUE(forced);
  forced->add("a.txt", "a");
  ASSERT_TRUE(forced->commit());
  EXPECT_EQ(*read_file(base_ / "thesis.tex"), "mine");
  EXPECT_EQ(entries(), 2u);
}

TEST_F(RunFolderTest, NothingIsLeftWithoutCommit) {
  {
    auto folder = RunFolder::open(base_ / "out", false);
    ASSERT_TRUE(folder);
    folder->add("a.txt", "a");
  }
  EXPECT_EQ(entries(), 0u);
}

TEST_F(RunFolderTest, AFileInTheWayIsRefused) {
  ASSERT_TRUE(write_file_atomically(base_ / "out", "x"));
  EXPECT_FALSE(RunFolder::open(base_ / "out", true));
}

} // namespace
} // namespace umov
