#pragma once
// Where the rows of a job go while it runs.

#include <filesystem>
#include <memory>
#include <umov/io/table.h>

namespace umov {

/// Takes a table block by block.
class TableSink {
public:
  virtual ~TableSink() = default;
  /// Rows with the same columns in the same order; the first block's notes are those of the whole.
  virtual Result<void> add(Table &&rows) = 0;
  /// What is known of the rows only after the first block: in the header of FITS, behind the rows
  /// of CSV, among the notes elsewhere. After all `add`.
  virtual Result<void> note(const std::string &key, const std::string &value) = 0;
  /// All rows were given.
  virtual Result<void> finish() = 0;
  /// The job ended early: what was given is kept, so marked that it is never taken for all. The
  /// error that the job ends with: `stopped`, and where the rows are.
  virtual Error stop(const Error &stopped) = 0;
};

/// A file by its suffix: .csv and .fits grow while they are written (on a thread of their own),
/// .ecsv and .json are written at the end. Rows of a stopped job go to "NAME.partial.SUFFIX". Usage
/// for another suffix, at `finish` or before.
std::unique_ptr<TableSink> make_file_sink(const std::filesystem::path &path, unsigned threads);

/// Writes a whole table to a file by its suffix, at once or not at all. Usage for another suffix.
Result<void> write_table(const std::filesystem::path &path, const Table &table);

} // namespace umov
