#include "io/table/fits_read.h"

#include "io/table/fits_layout.h"

#include <algorithm>
#include <cmath>
#include <fitsio.h>
#include <fmt/format.h>
#include <memory>
#include <umov/core/text.h>

namespace umov {
namespace {

struct Closer {
  void operator()(fitsfile *file) const {
    int status = 0;
    fits_close_file(file, &status);
    fits_clear_errmsg();
  }
};

/// Reads one file; CFITSIO's status goes from call to call.
class FitsReader {
public:
  FitsReader(std::string_view bytes, const std::string &file)
      : start_(const_cast<char *>(bytes.data())), size_(bytes.size()), name_(file) {}

  Result<TextTable> read();

private:
  Result<void> to_table();
  Result<void> read_columns(TextTable &out);
  Result<void> add_column(int column, TextTable &out);
  Result<void> read_cell(std::size_t column, std::size_t row, TextTable &out);
  void read_card(int number, TextTable &out);
  void read_notes(TextTable &out);
  [[nodiscard]] std::string key(const std::string &name);
  [[nodiscard]] tl::unexpected<Error> refuse(const std::string &what) const {
    char text[FLEN_STATUS] = {};
    if (status_ != 0)
      fits_get_errstatus(status_, text);
    fits_clear_errmsg();
    return fail(ErrorCode::BadInput,
                what + (status_ != 0 ? fmt::format(" (CFITSIO {}: {}). Export or fetch it again.",
                                                   status_, text)
                                     : ""),
                {name_});
  }

  void *start_; ///< CFITSIO only reads it, though its interface is not const
  std::size_t size_;
  const std::string &name_;
  std::unique_ptr<fitsfile, Closer> file_;
  std::vector<int> types_;                   ///< of the columns
  std::string cell_ = std::string(64, '\0'); ///< room for the longest text of one
  int status_ = 0;
};

std::string FitsReader::key(const std::string &name) {
  char value[FLEN_VALUE] = {};
  int status = 0;
  fits_read_key_str(file_.get(), name.c_str(), value, nullptr, &status);
  if (status != 0)
    fits_clear_errmsg();
  return status == 0 ? value : "";
}

/// A card of its own, as astropy writes the notes of a table: "PUPILS  = 'separate'", or "HIERARCH
/// pol_frame = 'altaz'". Keywords of eight letters are capitals in all FITS files, whatever a
/// writer meant.
void FitsReader::read_card(int number, TextTable &out) {
  char name[FLEN_KEYWORD] = {}, value[FLEN_VALUE] = {}, card[FLEN_CARD] = {};
  int status = 0;
  fits_read_record(file_.get(), number, card, &status);
  fits_read_keyn(file_.get(), number, name, value, nullptr, &status);
  std::string_view text = trimmed(std::string_view(value));
  if (status != 0 || fits_get_keyclass(card) != TYP_USER_KEY || text.empty())
    return;
  if (text.size() > 1 && text.starts_with('\'') && text.ends_with('\''))
    text = trimmed(text.substr(1, text.size() - 2));
  const std::string key(name);
  const bool is_long = std::string_view(card).starts_with("HIERARCH");
  out.notes.try_emplace(is_long || key == "POLCCONV" ? key : lower_case(key), text);
}

/// "COMMENT pol_frame: altaz", or a card of its own, of the part of the file that is current.
void FitsReader::read_notes(TextTable &out) {
  int cards = 0, status = 0;
  fits_get_hdrspace(file_.get(), &cards, nullptr, &status);
  for (int k = 1; k <= cards && status == 0; ++k) {
    char card[FLEN_CARD] = {};
    fits_read_record(file_.get(), k, card, &status);
    const std::string_view text(card);
    if (text.starts_with("COMMENT ") || text.starts_with("HISTORY "))
      put_note(trimmed(text.substr(8)), out.notes);
    else
      read_card(k, out);
  }
  fits_clear_errmsg();
}

Result<void> FitsReader::to_table() {
  int parts = 0;
  if (fits_get_num_hdus(file_.get(), &parts, &status_) != 0)
    return refuse("is damaged");
  for (int k = 1; k <= parts; ++k) {
    int kind = 0;
    if (fits_movabs_hdu(file_.get(), k, &kind, &status_) != 0)
      return refuse("is damaged");
    if (kind == BINARY_TBL || kind == ASCII_TBL)
      return {};
  }
  return refuse("holds no table: a binary table with one row a measurement was expected");
}

Result<void> FitsReader::add_column(int column, TextTable &out) {
  std::string name = key(fmt::format("TTYPE{}", column));
  if (std::ranges::find(out.columns, name) != out.columns.end())
    return refuse(fmt::format("column \"{}\" stands twice; leave one out", printable(name)));
  if (std::string unit = key(fmt::format("TUNIT{}", column)); !unit.empty())
    out.units[name] = std::move(unit);
  int type = 0;
  long repeat = 0, width = 0;
  if (fits_get_coltype(file_.get(), column, &type, &repeat, &width, &status_) != 0)
    return refuse("is damaged");
  if (type < 0 || type == TCOMPLEX || type == TDBLCOMPLEX || (type != TSTRING && repeat != 1))
    return refuse(fmt::format("column \"{}\" has more than one number in a row; columns of single "
                              "numbers and texts were expected",
                              printable(name)));
  out.columns.push_back(std::move(name));
  types_.push_back(type);
  const auto room = static_cast<std::size_t>(std::max(width, repeat)) + 1;
  // A table without rows holds no text that says how long one may be.
  if (room > size_)
    return refuse(
        fmt::format("column \"{}\" has texts of {} letters, more than the {} bytes of the "
                    "file: it was cut off or changed. Export or fetch it again.",
                    printable(out.columns.back()), room - 1, size_));
  cell_.resize(std::max(room, cell_.size()));
  return {};
}

Result<void> FitsReader::read_cell(std::size_t column, std::size_t row, TextTable &out) {
  const int at = static_cast<int>(column) + 1;
  const auto line = static_cast<LONGLONG>(row) + 1;
  int is_missing = 0;
  std::string value;
  if (types_[column] == TSTRING) {
    char *begin = cell_.data();
    char nothing[] = "";
    fits_read_col_str(file_.get(), at, line, 1, 1, nothing, &begin, &is_missing, &status_);
    value = trimmed(std::string_view(cell_.c_str()));
  } else if (types_[column] == TLOGICAL) {
    char is_true = 0;
    fits_read_col_log(file_.get(), at, line, 1, 1, 0, &is_true, &is_missing, &status_);
    value = is_true != 0 ? "True" : "False";
  } else {
    double number = 0;
    fits_read_col_dbl(file_.get(), at, line, 1, 1, std::nan(""), &number, &is_missing, &status_);
    value = std::isfinite(number) ? fmt::format("{}", number) : "";
  }
  if (status_ != 0)
    return refuse(fmt::format("column \"{}\", row {}: cannot be read",
                              printable(out.columns[column]), row + 1));
  out.add_cell(value);
  return {};
}

Result<void> FitsReader::read_columns(TextTable &out) {
  LONGLONG rows = 0;
  int columns = 0;
  fits_get_num_rowsll(file_.get(), &rows, &status_);
  fits_get_num_cols(file_.get(), &columns, &status_);
  if (status_ != 0 || rows < 0 || columns < 1)
    return refuse("holds a table without columns; one column or more was expected");
  // A cell takes a byte at least: a header that promises more is not believed.
  if (static_cast<std::size_t>(rows) > size_ / static_cast<std::size_t>(columns))
    return refuse(
        fmt::format("its header tells of {} rows, more than its {} bytes can hold: it was "
                    "cut off or changed. Export or fetch it again.",
                    rows, size_));
  if (static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns) > table_cells_max)
    return refuse(fmt::format("has more than {} cells, which would fill the memory; split the "
                              "table, or leave out columns",
                              table_cells_max));
  for (int c = 1; c <= columns; ++c)
    UMOV_TRY(add_column(c, out));
  for (std::size_t k = 0; k < static_cast<std::size_t>(rows); ++k) {
    for (std::size_t c = 0; c < types_.size(); ++c)
      UMOV_TRY(read_cell(c, k, out));
    out.end_row(k + 1);
  }
  return {};
}

Result<TextTable> FitsReader::read() {
  fitsfile *opened = nullptr;
  if (fits_open_memfile(&opened, "umov", READONLY, &start_, &size_, 0, nullptr, &status_) != 0)
    return refuse("is damaged or no FITS file");
  file_.reset(opened);
  TextTable out;
  read_notes(out);
  UMOV_TRY(to_table());
  read_notes(out);
  UMOV_TRY(read_columns(out));
  return out;
}

} // namespace

bool is_fits(std::string_view bytes) { return bytes.starts_with("SIMPLE  ="); }

Result<TextTable> read_fits_table(std::string_view bytes, const std::string &file) {
  UMOV_ASSIGN(table, fits_up_to_table(bytes, file));
  return FitsReader(table, file).read();
}

} // namespace umov
