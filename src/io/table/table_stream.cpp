#include <umov/io/table_stream.h>

#include "io/table/fits_table.h"
#include "io/table/row_texts.h"

#include <algorithm>
#include <optional>
#include <umov/core/files.h>
#include <umov/core/parallel.h>

namespace umov {
struct TableStream::Writer {
  FileInProgress file;
  std::optional<FitsTable> fits; ///< absent: CSV
  unsigned threads = 1;

  Result<void> append(const Table &table) {
    if (!fits)
      return write_rows(file, table, TextForm::Csv, threads);
    const std::size_t tasks = (table.rows() + rows_per_task - 1) / rows_per_task;
    std::vector<std::string> bytes(tasks);
    std::vector<Result<void>> done(tasks);
    parallel_for(tasks, threads, [&](std::size_t i) {
      const std::size_t begin = i * rows_per_task;
      const std::size_t end = std::min(table.rows(), begin + rows_per_task);
      done[i] = fits->encode(table, begin, end, bytes[i]);
    });
    for (std::size_t i = 0; i < tasks; ++i) {
      UMOV_TRY(done[i]);
      UMOV_TRY(fits->append(std::min(rows_per_task, table.rows() - i * rows_per_task), bytes[i]));
    }
    return {};
  }
};

bool is_streamed(const std::filesystem::path &path) {
  return path.extension() == ".csv" || path.extension() == ".fits";
}

Result<TableStream> TableStream::open(const std::filesystem::path &path, const Table &first,
                                      unsigned threads) {
  if (!is_streamed(path))
    return fail(ErrorCode::Usage,
                path.string() + ": a name that ends in .csv or .fits was expected");
  TableStream out;
  if (path.extension() == ".fits") {
    UMOV_ASSIGN(file, FileInProgress::for_library(path));
    UMOV_ASSIGN(fits, FitsTable::create(file.temporary(), first));
    file.hold();
    out.writer_ = std::make_unique<Writer>(Writer{std::move(file), std::move(fits), threads});
  } else {
    UMOV_ASSIGN(file, FileInProgress::open(path));
    UMOV_TRY(file.write(csv_header(first)));
    out.writer_ = std::make_unique<Writer>(Writer{std::move(file), {}, threads});
  }
  UMOV_TRY(out.append(first));
  return out;
}
TableStream::TableStream(TableStream &&) noexcept = default;
TableStream &TableStream::operator=(TableStream &&) noexcept = default;
TableStream::~TableStream() = default;

Result<void> TableStream::append(const Table &rows) { return writer_->append(rows); }

Result<void> TableStream::note(const std::string &key, const std::string &value) {
  const std::string text = key + ": " + value;
  return writer_->fits ? writer_->fits->note(text) : writer_->file.write(csv_note(text));
}

Result<void> TableStream::commit() {
  if (writer_->fits)
    UMOV_TRY(writer_->fits->close());
  return writer_->file.commit();
}

Result<std::filesystem::path> TableStream::commit_partial(const std::string &why) {
  std::filesystem::path path = writer_->file.path(); // in the folder of the temporary file
  path.replace_extension(".partial" + path.extension().string());
  UMOV_TRY(note("status", "stopped early: " + why));
  if (writer_->fits)
    UMOV_TRY(writer_->fits->close());
  UMOV_TRY(writer_->file.commit_as(path));
  return path;
}

} // namespace umov
