#pragma once
// Rows of a part of a job as they are, in a file that can be mapped into memory (docs/scale.md).

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <umov/core/files.h>
#include <umov/io/table.h>
#include <umov/jobs/ranged_job.h>
#include <vector>

namespace umov::scale {

/// What a file says of itself.
struct RowsHead {
  std::string key;          ///< of the job
  std::size_t index = 0;    ///< of the shard
  jobs::IndexRange range{}; ///< what of the job it holds
};

/// Writes one, block by block.
class RowsWriter final : public jobs::RangeSink {
public:
  /// Device if it cannot be made. `path` is where it grows; its name comes with `commit`.
  static Result<RowsWriter> open(const std::filesystem::path &path, std::vector<std::string> tables,
                                 RowsHead head);
  RowsWriter(RowsWriter &&) noexcept;
  RowsWriter &operator=(RowsWriter &&) noexcept;
  ~RowsWriter() override;

  Result<void> add(std::size_t table, Table &&rows) override;
  void tally(const std::vector<std::size_t> &counts) override;
  /// Ends the file; its SHA-256.
  Result<std::string> finish();
  /// Gives it its name, on the same file system, with all that it holds on disk.
  Result<void> commit_as(const std::filesystem::path &path);
  /// Rows of the first table so far.
  [[nodiscard]] std::size_t rows() const;
  /// Bytes of the file.
  [[nodiscard]] std::size_t bytes() const;

private:
  struct State;
  explicit RowsWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Reads one, mapped: only what is asked for is fetched.
class RowsFile {
public:
  /// BadInput for what is no such file, is cut off or contradicts itself.
  static Result<RowsFile> open(const std::filesystem::path &path);
  /// The same of bytes that stay where they are.
  static Result<RowsFile> read(std::string_view bytes, const std::string &name);
  RowsFile(RowsFile &&) noexcept;
  RowsFile &operator=(RowsFile &&) noexcept;
  ~RowsFile();

  /// What stands before the rows.
  [[nodiscard]] const RowsHead &head() const;
  /// Names of the tables.
  [[nodiscard]] const std::vector<std::string> &tables() const;
  /// Number of blocks of a table.
  [[nodiscard]] std::size_t blocks(std::size_t table) const;
  /// Number of rows of a table.
  [[nodiscard]] std::size_t rows(std::size_t table) const;
  /// Bytes of the longest text in each column of a table; 0 for numbers.
  [[nodiscard]] std::vector<std::size_t> widths(std::size_t table) const;
  /// RangeSink::tally; empty where the job has none.
  [[nodiscard]] const std::vector<std::size_t> &tallies() const;
  /// Rows of a block. BadInput for a text that stands nowhere.
  [[nodiscard]] Result<Table> block(std::size_t table, std::size_t number) const;
  /// SHA-256 of all its bytes.
  [[nodiscard]] std::string sha256() const;
  /// Bytes of the file.
  [[nodiscard]] std::size_t bytes() const;

private:
  struct State;
  explicit RowsFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

} // namespace umov::scale
