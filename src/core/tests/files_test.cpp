#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <umov/core/files.h>
#include <unistd.h>

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

class FilePlaces : public testing::Test {
protected:
  void SetUp() override {
    folder_ =
        fs::path(testing::TempDir()) /
        (std::string("umov_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "elsewhere");
  }
  fs::path folder_;
};

TEST_F(FilePlaces, LinksAreFollowedAlsoWhereTheyLeadToNothingYet) {
  fs::create_symlink("elsewhere/a.txt", folder_ / "link");
  fs::create_symlink("link", folder_ / "second");
  for (const char *bytes : {"new", "replaced"}) {
    ASSERT_TRUE(write_file_atomically(folder_ / "second", bytes));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link") && fs::is_symlink(folder_ / "second"));
    EXPECT_EQ(*read_file(folder_ / "elsewhere/a.txt"), bytes);
  }
  fs::create_symlink("circle", folder_ / "circle");
  EXPECT_EQ(write_file_atomically(folder_ / "circle", "x").error().code, ErrorCode::Device);
}

TEST_F(FilePlaces, APipeIsWrittenToAndStays) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  ASSERT_TRUE(write_file_atomically(pipe, "through"));
  char bytes[16] = {};
  EXPECT_EQ(::read(reader, bytes, sizeof bytes), 7);
  EXPECT_STREQ(bytes, "through");
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_FALSE(FileInProgress::for_library(pipe));
}

// As in `umov ... -o /dev/stdout >> all.txt`.
TEST_F(FilePlaces, AnOpenDescriptorIsWrittenToAsItStands) {
  const fs::path all = folder_ / "all.txt";
  ASSERT_TRUE(write_file_atomically(all, "first "));
  const int open = ::open(all.c_str(), O_WRONLY | O_APPEND);
  ASSERT_GE(open, 0);
  ASSERT_TRUE(write_file_atomically("/dev/fd/" + std::to_string(open), "second"));
  ::close(open);
  EXPECT_EQ(*read_file(all), "first second");
  ASSERT_TRUE(write_file_atomically("/dev/null", "x"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(FilePlaces, AReplacedFileKeepsItsPermissions) {
  const fs::path path = folder_ / "private";
  ASSERT_TRUE(write_file_atomically(path, "one"));
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_TRUE(write_file_atomically(path, "two"));
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  auto file = FileInProgress::open(path);
  ASSERT_TRUE(file);
  EXPECT_EQ(fs::status(file->temporary()).permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(FilePlaces, TemporaryNamesCannotBeForetoldAndPlantedLinksAreLeftAlone) {
  const fs::path path = folder_ / "a.txt", other = folder_ / "elsewhere/precious";
  ASSERT_TRUE(write_file_atomically(other, "precious"));
  fs::create_symlink(other, path.string() + ".part-" + std::to_string(::getpid()));
  ASSERT_TRUE(write_file_atomically(path, "ours"));
  EXPECT_EQ(*read_file(other), "precious");
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(path)));
  auto first = FileInProgress::open(path), second = FileInProgress::open(path);
  ASSERT_TRUE(first && second);
  EXPECT_NE(first->temporary(), second->temporary());
}

// A link of another user in a folder like /tmp; only root can make one for the test.
TEST_F(FilePlaces, LinksOfOthersInEverybodysFolderAreNotFollowed) {
  if (::geteuid() != 0)
    GTEST_SKIP() << "needs root";
  const fs::path other = folder_ / "precious", shared = folder_ / "shared";
  ASSERT_TRUE(write_file_atomically(other, "precious"));
  fs::create_directory(shared);
  fs::permissions(shared, fs::perms::all | fs::perms::sticky_bit);
  fs::create_symlink(other, shared / "out");
  ASSERT_EQ(::lchown((shared / "out").c_str(), 12345, 12345), 0);
  EXPECT_EQ(write_file_atomically(shared / "out", "x").error().code, ErrorCode::Device);
  EXPECT_EQ(*read_file(other), "precious");
}

TEST(Files, MissingInputIsBadInputAndUnwritableOutputIsDevice) {
  EXPECT_EQ(read_file("/no/such/file").error().code, ErrorCode::BadInput);
  EXPECT_EQ(read_file(testing::TempDir()).error().code, ErrorCode::BadInput);
  EXPECT_EQ(write_file_atomically("/no/such/folder/a", "x").error().code, ErrorCode::Device);
}

// Reading one's own memory from address zero gives an input/output error, as a bad disk does.
TEST(Files, AReadErrorIsNotTheEndOfTheFile) {
  const auto read = read_file("/proc/self/mem");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::Device);
  EXPECT_NE(read.error().message.find("cannot be read to its end: Input/output error"),
            std::string::npos)
      << read.error().text();
}

TEST(Files, RefusesWhatIsOverTheLimit) {
  const fs::path path = fs::path(testing::TempDir()) / "umov_limit_test";
  ASSERT_TRUE(write_file_atomically(path, std::string(100, 'x')));
  EXPECT_FALSE(read_file(path, 99));
  EXPECT_TRUE(read_file(path, 100));
}

} // namespace
} // namespace umov
