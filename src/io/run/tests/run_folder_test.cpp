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

TEST_F(RunFolderTest, OfAFileOfOthersIsNotReplacedOutsideTheWorkingFolder) {
  const auto refused = RunFolder::check_named_by_file(base_, "from/others.toml");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::BadInput);
  EXPECT_NE(refused.error().message.find("name it yourself: -o"), std::string::npos);
  EXPECT_TRUE(RunFolder::check_named_by_file(base_ / "new", "from/others.toml"));
  const fs::path before = fs::current_path();
  fs::current_path(base_);
  fs::create_directory("out");
  EXPECT_TRUE(RunFolder::check_named_by_file("out", "from/others.toml"));
  EXPECT_FALSE(RunFolder::check_named_by_file("out/../..", "from/others.toml"));
  fs::current_path(before);
}

// Names are bytes: a Latin-1 one must not end a run that is done.
TEST(Manifest, TakesNamesThatAreNotUtf8) {
  ManifestInput input;
  input.inputs = {{"caf\xE9.toml", "00"}};
  input.command_line = {"umov", "run", "caf\xE9.toml"};
  EXPECT_NE(make_manifest(input).find("caf\xEF\xBF\xBD.toml"), std::string::npos);
}

// Pages take most of a short run's time, and the manifest is made after them.
TEST(Manifest, CountsUntilItIsMade) {
  ManifestInput input;
  input.started -= std::chrono::seconds(100);
  const std::string text = make_manifest(input), key = "\"elapsed_s\": ";
  const std::size_t at = text.find(key);
  ASSERT_NE(at, std::string::npos);
  const double elapsed_s = std::stod(text.substr(at + key.size()));
  EXPECT_GE(elapsed_s, 100);
  EXPECT_LT(elapsed_s, 160); // as long as a busy machine may take for it
}

TEST_F(RunFolderTest, NothingIsLeftWithoutCommit) {
  {
    auto folder = RunFolder::open(base_ / "out", false);
    ASSERT_TRUE(folder);
    folder->add("a.txt", "a");
  }
  EXPECT_EQ(entries(), 0u);
}

// Hours may lie between the begin of a run and its end.
TEST_F(RunFolderTest, WhatComesInWhileTheRunGoesOnStays) {
  const fs::path out = base_ / "out";
  for (const char *round : {"first", "second"}) {
    auto folder = RunFolder::open(out, false);
    ASSERT_TRUE(folder);
    folder->add("manifest.json", make_manifest({}));
    folder->add("lightcurve.csv", round);
    if (fs::exists(out)) {
      ASSERT_TRUE(write_file_atomically(out / "notes.txt", "mine"));
      fs::create_directories(out / "figures");
      ASSERT_TRUE(write_file_atomically(out / "figures/a.txt", "mine too"));
    }
    ASSERT_TRUE(folder->commit());
  }
  EXPECT_EQ(*read_file(out / "lightcurve.csv"), "second");
  EXPECT_EQ(*read_file(out / "notes.txt"), "mine");
  EXPECT_EQ(*read_file(out / "figures/a.txt"), "mine too");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(RunFolderTest, AFolderOrFileThatTookTheNameMeanwhileStays) {
  const fs::path out = base_ / "out";
  for (const bool is_file : {true, false}) {
    auto folder = RunFolder::open(out, false);
    ASSERT_TRUE(folder);
    folder->add("log.txt", "ours");
    if (!is_file)
      fs::create_directory(out);
    const fs::path theirs = is_file ? out : out / "log.txt";
    ASSERT_TRUE(write_file_atomically(theirs, "mine"));
    ASSERT_TRUE(folder->commit());
    EXPECT_EQ(*read_file(theirs), "mine");
    EXPECT_EQ(folder->path(), base_ / "out.new");
    EXPECT_EQ(*read_file(base_ / "out.new/log.txt"), "ours");
    fs::remove_all(out);
    fs::remove_all(base_ / "out.new");
  }
}

TEST_F(RunFolderTest, AReplacedFolderKeepsItsPermissions) {
  const fs::path out = base_ / "out";
  for (int round = 0; round < 2; ++round) {
    auto folder = RunFolder::open(out, false);
    ASSERT_TRUE(folder);
    folder->add("manifest.json", make_manifest({}));
    ASSERT_TRUE(folder->commit());
    fs::permissions(out, round == 0 ? fs::perms::owner_all : fs::status(out).permissions());
  }
  EXPECT_EQ(fs::status(out).permissions(), fs::perms::owner_all);
}

TEST_F(RunFolderTest, AFileInTheWayIsRefused) {
  ASSERT_TRUE(write_file_atomically(base_ / "out", "x"));
  EXPECT_FALSE(RunFolder::open(base_ / "out", true));
}

} // namespace
} // namespace umov
