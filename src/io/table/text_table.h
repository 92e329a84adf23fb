#pragma once
// Private: a table of texts, from CSV or ECSV.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// No table has more cells: some 15 bytes each, and what they are made into.
inline constexpr std::size_t table_cells_max = 50'000'000;

/// Cells as they stand in a file, one behind the other in one text: a string of its own for each
/// would take fourteen times the file.
struct TextTable {
  std::vector<std::string> columns;
  std::size_t header_line = 0;    ///< of the names; 0 without lines, as in FITS
  std::vector<std::size_t> lines; ///< of each row
  std::map<std::string, std::string> notes;
  std::map<std::string, std::string> units; ///< by column, where the header tells them

  /// Number of rows that are complete.
  [[nodiscard]] std::size_t rows() const { return lines.size(); }
  /// A cell of a row and a column that are there; good until one is added.
  [[nodiscard]] std::string_view cell(std::size_t row, std::size_t column) const;
  /// The next cell of the row that is being added.
  void add_cell(std::string_view text);
  /// That row, which has a cell for each column, is complete.
  void end_row(std::size_t line);

private:
  std::string text_;
  std::vector<std::size_t> begins_; ///< of each row in the text
  std::vector<std::uint32_t> ends_; ///< of each cell behind the begin of its row
  std::size_t begin_ = 0;           ///< of the row that is being added
};
/// Blank-separated where the header is, else comma-separated. BadInput for an open quote, a ragged
/// row or a column that stands twice.
Result<TextTable> read_text_table(std::string_view text, const std::string &file);

/// Why the first line, as it stands in the file, holds no names of columns that can be told apart:
/// parted by semicolons. Empty if it may.
std::optional<std::string> why_no_names(std::string_view line);
/// Why its cells are no names: they are numbers and times. Empty if they may be.
std::optional<std::string> why_no_names(const std::vector<std::string> &columns);

/// Of a table without a column that it must have: `message`, or why it has no names at all before
/// it, in the line of the names.
tl::unexpected<Error> without_column(const TextTable &table, const std::string &file,
                                     const std::string &message);

/// Where a column stands; empty without it.
std::optional<std::size_t> column_named(const TextTable &table, std::string_view name);
/// The number in a cell. BadInput outside of a range: `what` was expected, and perhaps what to do.
Result<double> number_in(const TextTable &table, std::size_t row, std::size_t column, double low,
                         double high, std::string_view what, const std::string &file,
                         std::string_view advice = {});

/// Words of a header as people write them, "key: value", "key:value" or "key = value"; nothing
/// where they are other words.
void put_note(std::string_view words, std::map<std::string, std::string> &notes);

/// Angles of polarization that the header says to be other than from north through east: BadInput.
Result<void> check_polcconv(const TextTable &table, const std::string &file);

/// Where cell `cell` of line `line` (from 1) begins, for messages: columns count from 1.
std::size_t column_of_cell(std::string_view text, std::size_t line, std::size_t cell);

/// ASCII letters as small ones.
std::string lower_case(std::string text);
/// Truth as tables and spreadsheets write it, an empty cell being false; nothing for other words.
std::optional<bool> truth_of(std::string cell);

} // namespace umov
