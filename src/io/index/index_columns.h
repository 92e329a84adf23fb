#pragma once
// Private: tables of wavelength, n and k in columns.

#include <string>
#include <string_view>
#include <umov/io/index_file.h>

namespace umov {

/// The first line that is neither blank, comment nor header begins with a number and has two or
/// three words, one of which may be none.
bool is_index_columns(std::string_view text);
/// Blanks, commas or semicolons between the columns; nm or um as the header says, else as the
/// numbers are. BadInput names the line.
Result<IndexTable> read_index_columns(std::string_view text, const std::string &file);

} // namespace umov
