// A disk that is full at any byte of a FITS file: the C library tells CFITSIO where this looks
// away.

#include "io/table/fits_table.h"

#include <csignal>
#include <filesystem>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <umov/io/fits_image.h>
#include <vector>

namespace umov {
namespace {

namespace fs = std::filesystem;

class FitsWithoutRoom : public testing::Test {
protected:
  FitsWithoutRoom() { fs::create_directories(folder_); }
  ~FitsWithoutRoom() override { fs::remove_all(folder_); }
  fs::path folder_ = fs::path(testing::TempDir()) / "umov_fits_without_room";
  fs::path path_ = folder_ / "a.fits";
};

Result<void> write_table(const fs::path &path) {
  std::vector<double> numbers(3000);
  for (std::size_t k = 0; k < numbers.size(); ++k)
    numbers[k] = 1 / (1.0 + static_cast<double>(k));
  Table table;
  table.add("x", "", "a number", numbers);
  UMOV_ASSIGN(file, FitsTable::create(path, table));
  std::string bytes;
  UMOV_TRY(file.encode(table, 0, table.rows(), bytes));
  UMOV_TRY(file.append(table.rows(), bytes));
  UMOV_TRY(file.note("status: done"));
  return file.close();
}

Result<void> write_image(const fs::path &path) {
  std::vector<std::int32_t> pixels(100 * 100);
  for (std::size_t k = 0; k < pixels.size(); ++k)
    pixels[k] = static_cast<std::int32_t>(k * 7 % 65536);
  FitsImage image;
  image.columns = image.rows = 100;
  image.planes = {pixels, pixels};
  return write_fits_image(path, image);
}

// In a process of its own, whose files may not grow beyond so many bytes: 0 if it says so.
int write_within(Result<void> (*write)(const fs::path &), const fs::path &path, std::size_t size) {
  const rlimit limit{size, size};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, SIG_IGN);
  const auto done = write(path);
  return !done && done.error().code == ErrorCode::Device ? 0 : 1;
}

TEST_F(FitsWithoutRoom, IsToldAtAnyByte) {
  for (const auto write : {write_table, write_image}) {
    fs::remove(path_);
    const auto whole = write(path_);
    ASSERT_TRUE(whole) << whole.error().text();
    const auto size = static_cast<std::size_t>(fs::file_size(path_));
    ASSERT_EQ(size % 2880, 0u); // FITS 4.0, section 3.1
    for (std::size_t lost = 1; lost < size; lost += 719) {
      fs::remove(path_);
      EXPECT_EXIT(std::_Exit(write_within(write, path_, size - lost)), testing::ExitedWithCode(0),
                  "")
          << lost << " of " << size;
    }
  }
}

} // namespace
} // namespace umov
