#pragma once
// Private: a table of texts, from CSV or ECSV.

#include <map>
#include <optional>
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
  std::map<std::string, std::string> units; ///< by column, where the header tells them
};
/// Blank-separated where the header is, else comma-separated. BadInput for an open quote, a ragged
/// row or a column that stands twice.
Result<TextTable> read_text_table(std::string_view text, const std::string &file);

/// Angles of polarization that the header says to be other than from north through east: BadInput.
Result<void> check_polcconv(const TextTable &table, const std::string &file);

/// Where cell `cell` of line `line` (from 1) begins, for messages: columns count from 1.
std::size_t column_of_cell(std::string_view text, std::size_t line, std::size_t cell);

/// ASCII letters as small ones.
std::string lower_case(std::string text);
/// Truth as tables and spreadsheets write it, an empty cell being false; nothing for other words.
std::optional<bool> truth_of(std::string cell);

} // namespace umov
