// Rows as files: there and back, and what is no such file.

#include <umov/scale/rows_file.h>

#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>
#include <limits>
#include <umov/core/files.h>

namespace umov::scale {
namespace {

namespace fs = std::filesystem;

Table some_rows(int from, std::size_t count) {
  std::vector<double> numbers;
  std::vector<std::int64_t> counts;
  std::vector<std::string> texts;
  std::vector<bool> flags;
  for (std::size_t i = 0; i < count; ++i) {
    const int k = from + static_cast<int>(i);
    numbers.push_back(k == 3 ? std::numeric_limits<double>::quiet_NaN() : 0.1 * k);
    counts.push_back(k);
    texts.push_back(k % 2 == 0 ? "even" : "odd, \"" + std::to_string(k) + "\"");
    flags.push_back(k % 3 == 0);
  }
  Table out;
  out.add("x", "m2 / sr", "a number", std::move(numbers));
  out.add("n", "", "a count", std::move(counts));
  out.add("t", "", "a text", std::move(texts));
  out.add("f", "", "a truth", std::move(flags));
  out.note("object", "HST");
  out.set_precision("x", {"n", 3, 0});
  return out;
}

class RowsFiles : public ::testing::Test {
protected:
  void SetUp() override {
    folder = fs::path(::testing::TempDir()) /
             ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  std::string write() const {
    auto writer =
        RowsWriter::open(folder / "growing", {"first", "second"}, {"0123456789abcdef", 7, {70, 9}});
    EXPECT_TRUE(writer);
    EXPECT_TRUE(writer->add(0, some_rows(0, 5)));
    EXPECT_TRUE(writer->add(1, some_rows(100, 1)));
    EXPECT_TRUE(writer->add(0, some_rows(5, 4)));
    writer->tally({0, 12});
    const auto sum = writer->finish();
    EXPECT_TRUE(sum);
    EXPECT_TRUE(writer->commit_as(folder / "whole.rows"));
    return *sum;
  }
  fs::path folder;
};

TEST_F(RowsFiles, ComeBackAsTheyWere) {
  const std::string sum = write();
  const auto file = RowsFile::open(folder / "whole.rows");
  ASSERT_TRUE(file) << file.error().text();
  EXPECT_EQ(file->sha256(), sum);
  EXPECT_EQ(file->head().key, "0123456789abcdef");
  EXPECT_EQ(file->head().index, 7u);
  EXPECT_EQ(file->head().range.first, 70u);
  EXPECT_EQ(file->rows(0), 9u);
  EXPECT_EQ(file->tallies(), (std::vector<std::size_t>{0, 12}));
  // The longest text is odd, "7" of nine rows, and "even" of one.
  EXPECT_EQ(file->widths(0),
            (std::vector<std::size_t>{0, 0, std::string(R"(odd, "7")").size(), 0}));
  EXPECT_EQ(file->widths(1), (std::vector<std::size_t>{0, 0, 4, 0}));
  ASSERT_EQ(file->blocks(0), 2u);
  Table all = *file->block(0, 0);
  all.append(*file->block(0, 1));
  // All digits, texts, notes and precisions: the forms that people read are the same bytes.
  EXPECT_EQ(to_csv(all), to_csv(some_rows(0, 9)));
  EXPECT_EQ(to_ecsv(*file->block(1, 0)), to_ecsv(some_rows(100, 1)));
  EXPECT_EQ(fs::exists(folder / "growing"), false);
}

TEST_F(RowsFiles, AreTheSameBytesWhenWrittenAgain) {
  const std::string first = write();
  EXPECT_EQ(write(), first);
}

TEST_F(RowsFiles, CutOffAnywhereAreRefused) {
  write();
  const std::string bytes = *read_file(folder / "whole.rows");
  for (std::size_t length = 0; length < bytes.size(); length += 7)
    EXPECT_FALSE(RowsFile::read(std::string_view(bytes).substr(0, length), "cut")) << length;
}

/// The same file with `was` of its foot replaced; what ends it says where that begins and how long
/// it is, each in eight bytes of the machine, before the mark.
std::string with_foot(const std::string &bytes, const std::string &was, const std::string &is) {
  const std::size_t tail = bytes.size() - 24;
  std::uint64_t begin = 0;
  std::memcpy(&begin, bytes.data() + tail, 8);
  std::string foot = bytes.substr(begin, tail - begin);
  const std::size_t at = foot.find(was);
  EXPECT_NE(at, std::string::npos) << was << " in " << foot;
  if (at != std::string::npos)
    foot.replace(at, was.size(), is);
  const std::uint64_t length = foot.size();
  std::string out = bytes.substr(0, begin) + foot + bytes.substr(tail);
  std::memcpy(out.data() + out.size() - 16, &length, 8);
  return out;
}

TEST_F(RowsFiles, OfDigitsThatNoDoubleHasAreRefused) {
  write();
  const std::string bytes = *read_file(folder / "whole.rows"), was = R"(["n",3,0])";
  for (const char *good : {R"(["n",-3,0])", R"(["n",330,0])", R"(["n",0,17])"})
    EXPECT_TRUE(RowsFile::read(with_foot(bytes, was, good), "good")) << good;
  for (const char *bad :
       {R"(["n",18446744073709551615,0])", R"(["n",0,18446744073709551615])", R"(["n",0,-1])",
        R"(["n",0,18])", R"(["n",331,0])", R"(["n",-331,0])", R"(["n",0.5,0])"}) {
    const auto read = RowsFile::read(with_foot(bytes, was, bad), "bad");
    ASSERT_FALSE(read) << bad;
    EXPECT_NE(read.error().message.find("precision is no number of digits from"), std::string::npos)
        << read.error().message;
  }
}

TEST_F(RowsFiles, WithoutListsWhereListsStandAreRefused) {
  write();
  const std::string bytes = *read_file(folder / "whole.rows");
  for (const char *key : {"notes", "columns", "blocks", "tables", "tallies"})
    for (const char *bad : {"null", "{}", "7"}) {
      // What stood there goes on under a key that nobody asks for.
      const std::string was = '"' + std::string(key) + R"(":)";
      const auto read = RowsFile::read(with_foot(bytes, was, was + bad + R"(,"x":)"), "bad");
      ASSERT_FALSE(read) << key << " " << bad;
      EXPECT_NE(read.error().message.find(std::string(key) + " is no list"), std::string::npos)
          << read.error().message;
    }
}

TEST_F(RowsFiles, WithAnyByteChangedAreReadOrRefusedButNeverBeyondTheirEnd) {
  write(); // under the address sanitizer this is what it says
  const std::string bytes = *read_file(folder / "whole.rows");
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x11);
    const auto file = RowsFile::read(changed, "changed");
    for (std::size_t table = 0; file && table < file->tables().size(); ++table)
      for (std::size_t b = 0; b < file->blocks(table); ++b)
        (void)file->block(table, b);
  }
}

} // namespace
} // namespace umov::scale
