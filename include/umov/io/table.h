#pragma once
// A small table of named columns with units, and its forms in files.

#include <cstdint>
#include <string>
#include <string_view>
#include <umov/core/result.h>
#include <utility>
#include <variant>
#include <vector>

namespace umov {

/// Cells of one column; NaN means "not defined".
using Cells = std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::string>,
                           std::vector<bool>>;

/// How fine a CSV writes numbers; by default to all digits.
struct Precision {
  std::string error =
      {};              ///< the column of its half-width: as fine as two digits of that, ten at most
  int decimals = 0;    ///< so many after the point
  int significant = 0; ///< so many digits

  bool operator==(const Precision &) const = default;
};

/// A named column with its unit.
struct Column {
  std::string name;
  std::string unit;        ///< as astropy spells it ("W / (m2 nm)"); "" = dimensionless
  std::string description; ///< one line
  Cells cells;
  Precision precision = {}; ///< of its CSV; all other forms have all digits
  std::size_t width = 0;    ///< bytes of the longest text that later blocks of rows bring
};

/// Columns of one length, in order, and what is said about the whole in a file's header.
class Table {
public:
  /// Adds a column, which must be as long as those before it (else it is cut or filled up with
  /// NaN, 0, "" or false) and have a new name.
  void add(std::string name, std::string unit, std::string description, Cells cells);
  /// Rows of a table with the same columns; an empty table becomes that one.
  void append(Table &&rows);
  /// Rows [first, first + count), with all that is said of them.
  [[nodiscard]] Table part(std::size_t first, std::size_t count) const;
  /// Leaves a column out, if there is one of that name.
  void remove(std::string_view name);
  /// Adds one line of the header ("object" -> "HST").
  void note(std::string key, std::string value);

  /// How fine a CSV writes a column, if there is one of that name.
  void set_precision(std::string_view name, Precision precision);
  /// Says how long texts of a column are in blocks that are still to come.
  void set_width(std::string_view name, std::size_t width);
  /// All columns to all digits.
  void clear_precision();

  /// Number of rows.
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// All columns, in order.
  [[nodiscard]] const std::vector<Column> &columns() const { return columns_; }
  /// Lines of the header, in order.
  [[nodiscard]] const std::vector<std::pair<std::string, std::string>> &notes() const {
    return notes_;
  }
  /// The column of that name, or null.
  [[nodiscard]] const Column *find(std::string_view name) const;
  /// A cell as a number; NaN if there is no such column or row or it holds text.
  [[nodiscard]] double number(std::string_view name, std::size_t row) const;
  /// A cell as the CSV has it; "" if there is none.
  [[nodiscard]] std::string text(std::string_view name, std::size_t row) const;

private:
  std::size_t rows_ = 0;
  std::vector<Column> columns_;
  std::vector<std::pair<std::string, std::string>> notes_;
};

/// Enhanced CSV 1.0 (Astropy APE 6): names, types, units and notes in the header, blank-separated
/// rows, NaN as "nan". Every column but text and truth values carries a unit.
std::string to_ecsv(const Table &table);
/// RFC 4180 with LF, numbers as fine as the precision of their column; where there are notes, a
/// first comment says how to read it; they follow as "# key: value", then "# unit: ..." above the
/// header; NaN is an empty cell; a ' stands before a text that spreadsheets would compute as a
/// formula.
std::string to_csv(const Table &table);
/// A binary table of a FITS file (standard 4.0); where it has time_utc, I and I_err, they follow
/// once more as `time` (MJD), `flux` and `flux_err`, as readers of light curves want them. BadInput
/// for text that a column cannot hold.
Result<std::string> to_fits(const Table &table);
/// Its two parts: everything above the rows, and rows [begin, end).
std::string csv_header(const Table &table);
/// A line that readers of the CSV skip.
std::string csv_note(const std::string &text);
/// Rows [begin, end) of the CSV, appended to `out`.
void append_csv_rows(const Table &table, std::size_t begin, std::size_t end, std::string &out);
/// An array of objects; NaN is null.
std::string to_json(const Table &table);
/// Aligned columns for a terminal, numbers to six digits.
std::string to_text(const Table &table);
/// Columns of a table by name, in the order asked for. Usage with the nearest name for an unknown
/// one.
Result<Table> with_columns(const Table &table, const std::vector<std::string> &names);
/// The same without columns in which no row says anything; notes are kept.
Table without_empty_columns(const Table &table);

/// Reads the `required` numeric columns of a CSV text, and those of `optional` that are there;
/// others are ignored. A last column "line" tells where each row stands. Lines that start with '#'
/// and blank ones are skipped; the first other line is the header. BadInput with line and column
/// for a missing column, a ragged row or what is not a finite number.
Result<Table> read_csv(std::string_view text, const std::string &file,
                       const std::vector<std::string> &required,
                       const std::vector<std::string> &optional = {});

/// Puts what every output of the project says into the header: versions and conventions.
void note_conventions(Table &table);

} // namespace umov
