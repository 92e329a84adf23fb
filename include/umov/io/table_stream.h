#pragma once
// Tables that grow while they are written: a million rows need no memory.

#include <filesystem>
#include <memory>
#include <umov/io/table.h>

namespace umov {

/// A file of rows: .csv, or .fits (a binary table of the FITS standard 4.0).
class TableStream {
public:
  /// `first` gives names, units, descriptions, types and notes; its rows are written. In FITS, text
  /// cells of later rows may not be longer than the longest of these. Usage for another suffix,
  /// Device if a file cannot be made there.
  static Result<TableStream> open(const std::filesystem::path &path, const Table &first,
                                  unsigned threads = 1);
  TableStream(TableStream &&) noexcept;
  TableStream &operator=(TableStream &&) noexcept;
  ~TableStream(); ///< without `commit` no file is left

  /// Rows with the same columns in the same order.
  Result<void> append(const Table &rows);
  /// A line in the header of FITS, or behind the rows that there are of CSV.
  Result<void> note(const std::string &key, const std::string &value);
  /// Puts the complete file in place. Device if that fails.
  Result<void> commit();
  /// Under the name "stem.partial.suffix", for what was stopped early; a note says so: in the
  /// header of FITS, behind the rows of CSV. Returns the name.
  Result<std::filesystem::path> commit_partial(const std::string &why);

  struct Writer;

private:
  TableStream() = default;
  std::unique_ptr<Writer> writer_;
};

/// True if `TableStream` writes files of that name.
bool is_streamed(const std::filesystem::path &path);

} // namespace umov
