#pragma once
// Private: a table of texts, from CSV or ECSV.

#include <map>
#include <string>
#include <string_view>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// Cells as they stand in a file.
struct TextTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> lines; ///< of each row
  std::map<std::string, std::string> notes;
};
/// Blank-separated where the header is, else comma-separated. BadInput for an open quote, a ragged
/// row or a column that stands twice.
Result<TextTable> read_text_table(std::string_view text, const std::string &file);

} // namespace umov
