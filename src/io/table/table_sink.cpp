#include <umov/io/table_sink.h>

#include "io/table/light_curve_names.h"
#include "io/table/row_texts.h"

#include <algorithm>
#include <future>
#include <optional>
#include <span>
#include <system_error>
#include <umov/core/files.h>
#include <umov/io/table_stream.h>
#include <vector>

namespace umov {
namespace {

namespace fs = std::filesystem;

std::string joined(const std::string &sentence, const std::string &more) {
  return sentence + (sentence.ends_with('.') ? " " : ". ") + more;
}

fs::path partial_name(fs::path path) {
  return path.replace_extension(".partial" + path.extension().string());
}

/// An ECSV of blocks of rows, whose notes are those of the first.
Result<void> write_ecsv(const fs::path &path, std::span<const Table> blocks, unsigned threads) {
  UMOV_ASSIGN(file, FileInProgress::open(path));
  UMOV_TRY(file.write(ecsv_header(blocks.front())));
  for (const Table &rows : blocks)
    UMOV_TRY(write_rows(file, rows, TextForm::Ecsv, threads));
  return file.commit();
}

/// Rows that are kept until the end, as what is noted of them last stands above the first.
class WholeFile final : public TableSink {
public:
  WholeFile(fs::path path, unsigned threads) : path_(std::move(path)), threads_(threads) {}
  Result<void> add(Table &&rows) override {
    blocks_.push_back(std::move(rows));
    return {};
  }
  Result<void> note(const std::string &key, const std::string &value) override {
    head().note(key, value);
    return {};
  }
  Result<void> finish() override { return write(path_); }
  Error stop(const Error &stopped) override {
    Error out = stopped;
    if (std::ranges::all_of(blocks_, [](const Table &rows) { return rows.rows() == 0; }))
      return out;
    head().note("status", "stopped early: " + stopped.message);
    const fs::path target = partial_name(path_);
    if (const auto done = write(target); !done)
      out.message = joined(out.message, "The finished rows are lost: " + done.error().text());
    else
      out.message = joined(out.message, "The finished rows are in " + target.string() + ".");
    return out;
  }

private:
  Table &head() { return blocks_.empty() ? blocks_.emplace_back() : blocks_.front(); }
  Result<void> write(const fs::path &path) {
    Table &all = head();
    if (path.extension() == ".ecsv")
      return write_ecsv(path, blocks_, threads_);
    for (std::size_t k = 1; k < blocks_.size(); ++k)
      all.append(std::move(blocks_[k]));
    return write_table(path, all);
  }
  fs::path path_;
  unsigned threads_;
  std::vector<Table> blocks_;
};

/// Rows that are written as they come: the disk works while the next block is computed.
class GrowingFile final : public TableSink {
public:
  GrowingFile(fs::path path, unsigned threads) : path_(std::move(path)), threads_(threads) {}
  ~GrowingFile() override { (void)settle(); }

  Result<void> add(Table &&rows) override {
    if (!stream_) {
      UMOV_ASSIGN(opened, TableStream::open(path_, rows, threads_));
      stream_.emplace(std::move(opened));
      return {};
    }
    UMOV_TRY(settle());
    const auto append = [this, rows = std::move(rows)] { return stream_->append(rows); };
    try {
      writing_ = std::async(std::launch::async, append);
    } catch (const std::system_error &) { // no thread to be had: the rows are written here
      return append();
    }
    return {};
  }
  Result<void> note(const std::string &key, const std::string &value) override {
    UMOV_TRY(settle());
    return stream_ ? stream_->note(key, value) : Result<void>();
  }
  Result<void> finish() override {
    UMOV_TRY(settle());
    return stream_ ? stream_->commit() : Result<void>();
  }
  Error stop(const Error &stopped) override {
    if (!stream_)
      return stopped;
    if (const auto done = settle(); !done)
      return done.error();
    const auto kept = stream_->commit_partial(stopped.message);
    if (!kept)
      return kept.error();
    Error out = stopped;
    out.message = joined(out.message, "The finished rows are in " + kept->string() + ".");
    return out;
  }

private:
  Result<void> settle() { return writing_.valid() ? writing_.get() : Result<void>(); }
  fs::path path_;
  unsigned threads_;
  std::optional<TableStream> stream_;
  std::future<Result<void>> writing_; ///< ends before what it writes to
};

} // namespace

Result<void> write_table(const fs::path &path, const Table &table) {
  const std::string suffix = path.extension().string();
  if (suffix == ".csv")
    return write_file_atomically(path, to_csv(table));
  if (suffix == ".ecsv")
    return write_ecsv(path, {&table, 1}, 1);
  if (suffix == ".json")
    return write_file_atomically(path, to_json(table));
  if (suffix == ".fits") {
    UMOV_ASSIGN(stream, TableStream::open(path, with_light_curve(table)));
    return stream.commit();
  }
  return fail(ErrorCode::Usage, "-o " + path.string() +
                                    ": a name that ends in .csv, .ecsv, .fits or .json was "
                                    "expected");
}

std::unique_ptr<TableSink> make_file_sink(const fs::path &path, unsigned threads) {
  if (is_streamed(path))
    return std::make_unique<GrowingFile>(path, threads);
  return std::make_unique<WholeFile>(path, threads);
}

} // namespace umov
