#pragma once
// Private: rows of a table as lines of text.

#include <cstddef>
#include <string>
#include <umov/core/files.h>
#include <umov/io/table.h>

namespace umov {

/// Rows that one thread turns into bytes at a time.
inline constexpr std::size_t rows_per_task = 4096;

/// RFC 4180 with the precision of the columns, or blank-separated with all digits.
enum class TextForm { Csv, Ecsv };

/// A text as such a form has it, in quotes where it needs them.
std::string quoted_cell(const std::string &text, TextForm form);
/// Everything above the rows of `to_ecsv`.
std::string ecsv_header(const Table &table);
/// Rows [begin, end), appended to `out`.
void append_rows(const Table &table, std::size_t begin, std::size_t end, TextForm form,
                 std::string &out);
/// All rows to the end of a file, made by so many threads; some thousands are in memory at a time.
Result<void> write_rows(FileInProgress &file, const Table &table, TextForm form, unsigned threads);

} // namespace umov
