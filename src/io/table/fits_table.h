#pragma once
// Private: a binary table of a FITS file, written through CFITSIO.

#include <filesystem>
#include <memory>
#include <umov/io/table.h>

namespace umov {
class FitsWritten;

/// Makes the file and its header at once; rows come as bytes, in order.
class FitsTable {
public:
  /// Device with CFITSIO's words if the file cannot be made.
  static Result<FitsTable> create(const std::filesystem::path &path, const Table &columns);
  /// The same without a file: `take` gives its bytes.
  static Result<FitsTable> create_in_memory(const Table &columns);
  FitsTable(FitsTable &&other) noexcept;
  FitsTable &operator=(FitsTable &&other) noexcept;
  ~FitsTable();

  /// Rows [begin, end) as the bytes of the file. Pure: for many threads. BadInput for a text that
  /// is longer than its column.
  Result<void> encode(const Table &table, std::size_t begin, std::size_t end,
                      std::string &out) const;
  Result<void> append(std::size_t rows, const std::string &bytes);
  Result<void> note(const std::string &text);
  /// Device if the file does not hold what was written.
  Result<void> close();
  /// Finishes what was made in memory.
  Result<std::string> take();

private:
  /// What CFITSIO enlarges by `realloc`.
  struct Memory {
    void *bytes = nullptr;
    std::size_t size = 0;
    ~Memory();
  };
  FitsTable();
  Result<void> begin(const Table &columns, int status);
  Result<void> check(int status, const char *action) const;
  void *file_ = nullptr;                 ///< fitsfile
  std::unique_ptr<Memory> memory_;       ///< CFITSIO keeps its address
  std::unique_ptr<FitsWritten> written_; ///< of a file
  std::filesystem::path path_;
  std::vector<std::size_t> widths_; ///< bytes per column
  std::size_t row_bytes_ = 0;
  long long rows_ = 0;
};

} // namespace umov
