#include <csignal>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <umov/core/files.h>
#include <umov/core/journal.h>

namespace umov {
namespace {

namespace fs = std::filesystem;
using Found = Journal::Found;

class JournalFile : public testing::Test {
protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("umov_journal_") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    path_ = folder_ / "rows.partial";
  }
  /// Without a flush to disk, which hundreds of times takes its time.
  void write(const std::string &bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
  }
  Journal opened(std::string_view job = "job") {
    auto out = Journal::open(path_, job);
    EXPECT_TRUE(out);
    return std::move(*out);
  }
  fs::path folder_, path_;
};

TEST_F(JournalFile, IsMadeWithTheFirstBlockAndGoesWithTheJob) {
  Journal journal = opened();
  EXPECT_FALSE(fs::exists(path_));
  journal.keep({0, 1}, "abc");
  EXPECT_TRUE(fs::exists(path_));
  EXPECT_EQ(journal.find({0, 1}), "abc");
  EXPECT_FALSE(journal.find({1, 1}));
  journal.finish();
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(JournalFile, GivesItsBlocksToTheSameJobOnly) {
  {
    Journal journal = opened();
    journal.keep({0, 0}, "first");
    journal.keep({2, 7}, std::string(100'000, 'x'));
  }
  {
    const Journal journal = opened();
    EXPECT_EQ(journal.found(), Found::Ours);
    EXPECT_EQ(journal.count(), 2u);
    EXPECT_EQ(journal.find({2, 7}), std::string(100'000, 'x'));
  }
  Journal other = opened("other job");
  EXPECT_EQ(other.found(), Found::Foreign);
  EXPECT_EQ(other.count(), 0u);
  other.keep({0, 0}, "new");
  other = Journal();
  EXPECT_EQ(opened("other job").find({0, 0}), "new");
}

// Who lit the blocks is known after a kill, and is not a block.
TEST_F(JournalFile, RemembersWhatWasRemarkedOfEachPart) {
  {
    Journal journal = opened();
    journal.remark(0, "a card");
    journal.keep({0, 0}, "first");
    journal.remark(0, "a card");
    journal.remark(1, "");
    journal.remark(3, "another");
  }
  Journal journal = opened();
  EXPECT_EQ(journal.count(), 1u);
  journal.remark(0, "the processor");
  journal = Journal();
  const Journal again = opened();
  EXPECT_EQ(again.remarks(0), (std::vector<std::string>{"a card", "the processor"}));
  EXPECT_TRUE(again.remarks(1).empty());
  EXPECT_EQ(again.remarks(3), std::vector<std::string>{"another"});
  EXPECT_EQ(again.find({0, 0}), "first");
  Journal nowhere;
  nowhere.remark(0, "a card");
  EXPECT_EQ(nowhere.remarks(0), std::vector<std::string>{"a card"});
}

// As kill -9 leaves it at any moment.
TEST_F(JournalFile, WhateverIsTornOrDamagedIsDroppedWithWhatFollows) {
  {
    Journal journal = opened();
    journal.keep({0, 0}, "first block");
    journal.keep({0, 1}, "second block");
  }
  const std::string whole = *read_file(path_);
  std::size_t most = 0;
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    write(whole.substr(0, cut));
    Journal journal = opened();
    ASSERT_GE(journal.count(), most);
    most = journal.count();
    journal.keep({0, 2}, "third");
    journal = Journal();
    const Journal again = opened();
    EXPECT_EQ(again.count(), most + 1) << cut;
    EXPECT_EQ(again.find({0, 2}), "third");
  }
  EXPECT_EQ(most, 2u);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x40);
    write(bytes);
    const auto journal = Journal::open(path_, "job");
    if (!journal)
      continue; // the first line: no journal
    EXPECT_EQ(journal->find({0, 0}).value_or("first block"), "first block") << at;
    EXPECT_EQ(journal->find({0, 1}).value_or("second block"), "second block") << at;
  }
}

TEST_F(JournalFile, WhatIsNoJournalIsRefused) {
  ASSERT_TRUE(write_file_atomically(path_, "my notes"));
  EXPECT_EQ(Journal::open(path_, "job").error().code, ErrorCode::Device);
  EXPECT_EQ(*read_file(path_), "my notes");
  fs::remove(path_);
  fs::create_symlink("elsewhere", path_);
  EXPECT_EQ(Journal::open(path_, "job").error().code, ErrorCode::Device);
  fs::remove(path_);
  fs::create_directory(path_);
  EXPECT_EQ(Journal::open(path_, "job").error().code, ErrorCode::Device);
}

TEST_F(JournalFile, OneProcessAtATimeHasIt) {
  Journal first = opened();
  first.keep({0, 0}, "one");
  Journal second = opened();
  EXPECT_EQ(second.found(), Found::Busy);
  second.keep({0, 0}, "two");
  EXPECT_EQ(first.find({0, 0}), "one");
  EXPECT_FALSE(second.problem());
}

// In a process of its own, whose files may not grow beyond a page.
int keep_without_room(const fs::path &path) {
  auto journal = Journal::open(path, "job");
  if (!journal)
    return 1;
  journal->keep({0, 0}, "small");
  const rlimit limit{4096, 4096};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, SIG_IGN);
  journal->keep({0, 1}, std::string(10'000, 'x'));
  const bool is_told = journal->problem() && journal->problem()->code == ErrorCode::Device;
  return is_told && journal->find({0, 0}) == "small" && !fs::exists(path) ? 0 : 1;
}

TEST_F(JournalFile, WithoutRoomTheFileGoesAndTheJobGoesOn) {
  EXPECT_EXIT(std::_Exit(keep_without_room(path_)), testing::ExitedWithCode(0), "");
}

} // namespace
} // namespace umov
