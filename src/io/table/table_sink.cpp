#include <umov/io/table_sink.h>

#include "io/table/light_curve_names.h"

#include <future>
#include <optional>
#include <system_error>
#include <umov/core/files.h>
#include <umov/io/table_stream.h>

namespace umov {
namespace {

namespace fs = std::filesystem;

std::string joined(const std::string &sentence, const std::string &more) {
  return sentence + (sentence.ends_with('.') ? " " : ". ") + more;
}

fs::path partial_name(fs::path path) {
  return path.replace_extension(".partial" + path.extension().string());
}

/// Rows that are kept until the end.
class WholeFile final : public TableSink {
public:
  explicit WholeFile(fs::path path) : path_(std::move(path)) {}
  Result<void> add(Table &&rows) override {
    table_.append(std::move(rows));
    return {};
  }
  Result<void> note(const std::string &key, const std::string &value) override {
    table_.note(key, value);
    return {};
  }
  Result<void> finish() override { return write_table(path_, table_); }
  Error stop(const Error &stopped) override {
    Error out = stopped;
    if (table_.rows() == 0)
      return out;
    table_.note("status", "stopped early: " + stopped.message);
    const fs::path target = partial_name(path_);
    if (const auto done = write_table(target, table_); !done)
      out.message = joined(out.message, "The finished rows are lost: " + done.error().text());
    else
      out.message = joined(out.message, "The finished rows are in " + target.string() + ".");
    return out;
  }

private:
  fs::path path_;
  Table table_;
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
    return write_file_atomically(path, to_ecsv(table));
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
  return std::make_unique<WholeFile>(path);
}

} // namespace umov
