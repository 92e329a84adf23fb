#include "io/table/fits_table.h"
#include "io/table/fits_written.h"
#include "io/table/light_curve_names.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fitsio.h>
#include <fmt/format.h>
#include <umov/core/text.h>
#include <utility>

namespace umov {
namespace {

fitsfile *as_fits(void *file) { return static_cast<fitsfile *>(file); }

/// Width and TFORM of a column.
struct Form {
  std::size_t bytes;
  std::string text;
};
Form form_of(const Column &column) {
  const Cells &cells = column.cells;
  if (std::holds_alternative<std::vector<double>>(cells))
    return {8, "1D"};
  if (std::holds_alternative<std::vector<std::int64_t>>(cells))
    return {8, "1K"};
  if (std::holds_alternative<std::vector<bool>>(cells))
    return {1, "1L"};
  std::size_t longest = std::max<std::size_t>(1, column.width);
  for (const std::string &text : std::get<std::vector<std::string>>(cells))
    longest = std::max(longest, text.size());
  return {longest, fmt::format("{}A", longest)};
}

/// FITS numbers are big-endian.
void append_big_endian(std::uint64_t bits, std::string &out) {
  char bytes[8];
  for (std::size_t k = 0; k < 8; ++k)
    bytes[k] = static_cast<char>(bits >> (56 - 8 * k));
  out.append(bytes, 8);
}

/// "W / (m2 nm)" as FITS has it (standard 4.0, section 4.3): no blanks around the solidus, and no
/// zero points of magnitudes, which the column's description names.
std::string fits_unit(std::string unit) {
  if (unit.starts_with("mag("))
    return "mag";
  for (std::size_t at = 0; (at = unit.find(" / ")) != std::string::npos;)
    unit.replace(at, 3, "/");
  return unit;
}

/// Printable ASCII, which is all that a header may hold.
std::string fits_text(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < 32 || c > 126; }, '?');
  return text;
}

} // namespace

Result<void> FitsTable::check(int status, const char *action) const {
  if (status == 0)
    return {};
  char text[FLEN_STATUS] = {};
  fits_get_errstatus(status, text);
  fits_clear_errmsg();
  return fail(ErrorCode::Device,
              fmt::format("cannot {}: {} (CFITSIO {}). Choose another folder or free some space.",
                          action, text, status),
              {path_.string()});
}

FitsTable::FitsTable() = default;
FitsTable::Memory::~Memory() { std::free(bytes); }

Result<FitsTable> FitsTable::create(const std::filesystem::path &path, const Table &columns) {
  FitsTable out;
  out.path_ = path;
  out.written_ = std::make_unique<FitsWritten>();
  int status = 0;
  fitsfile *file = nullptr;
  errno = 0;
  fits_create_diskfile(&file, path.c_str(), &status); // no extended file-name syntax
  out.file_ = file;
  if (status != 0 && errno != 0) // CFITSIO does not say why
    return fail(ErrorCode::Device,
                fmt::format("cannot make the file: {}. Choose another folder or free some space.",
                            std::strerror(errno)),
                {path.string()});
  UMOV_TRY(out.begin(columns, status));
  return out;
}

Result<FitsTable> FitsTable::create_in_memory(const Table &columns) {
  FitsTable out;
  out.path_ = "memory";
  out.memory_ = std::make_unique<Memory>();
  int status = 0;
  fitsfile *file = nullptr;
  constexpr std::size_t step = 1 << 16;
  fits_create_memfile(&file, &out.memory_->bytes, &out.memory_->size, step, std::realloc, &status);
  out.file_ = file;
  UMOV_TRY(out.begin(columns, status));
  return out;
}

/// Writes the header.
Result<void> FitsTable::begin(const Table &columns, int status) {
  UMOV_TRY(check(status, "make the file"));
  std::vector<std::string> names, forms, units;
  for (const Column &c : columns.columns()) {
    const Form form = form_of(c);
    names.push_back(printable(c.name));
    forms.push_back(form.text);
    units.push_back(fits_text(fits_unit(c.unit)));
    widths_.push_back(form.bytes);
    row_bytes_ += form.bytes;
  }
  const auto pointers = [](std::vector<std::string> &texts) {
    std::vector<char *> p;
    for (std::string &text : texts)
      p.push_back(text.data());
    return p;
  };
  auto name = pointers(names), form = pointers(forms), unit = pointers(units);
  fitsfile *file = as_fits(file_);
  fits_create_tbl(file, BINARY_TBL, 0, static_cast<int>(names.size()), name.data(), form.data(),
                  unit.data(), "UMOV", &status);
  for (std::size_t i = 0; i < columns.columns().size(); ++i)
    fits_modify_comment(file, fmt::format("TTYPE{}", i + 1).c_str(),
                        printable(columns.columns()[i].description).c_str(), &status);
  UMOV_TRY(check(status, "write the header"));
  for (const auto &[key, value] : columns.notes()) {
    if (key == "POLCCONV") // a keyword of its own (Hamaker & Bregman 1996; astropy's convention)
      fits_write_key_str(file, "POLCCONV", value.c_str(), "convention of Q, U", &status);
    else
      fits_write_comment(file, fits_text(key + ": " + value).c_str(), &status);
  }
  return check(status, "write the header");
}

FitsTable::FitsTable(FitsTable &&other) noexcept { *this = std::move(other); }
FitsTable &FitsTable::operator=(FitsTable &&other) noexcept {
  std::swap(file_, other.file_);
  std::swap(memory_, other.memory_);
  std::swap(written_, other.written_);
  path_ = std::move(other.path_);
  widths_ = std::move(other.widths_);
  row_bytes_ = other.row_bytes_;
  rows_ = other.rows_;
  return *this;
}
FitsTable::~FitsTable() {
  int status = 0;
  if (file_ != nullptr)
    fits_close_file(as_fits(file_), &status);
}

Result<void> FitsTable::encode(const Table &table, std::size_t begin, std::size_t end,
                               std::string &out) const {
  out.reserve(out.size() + (end - begin) * row_bytes_);
  for (std::size_t row = begin; row < end; ++row)
    for (std::size_t c = 0; c < widths_.size(); ++c) {
      const Cells &cells = table.columns()[c].cells;
      if (const auto *numbers = std::get_if<std::vector<double>>(&cells)) {
        append_big_endian(std::bit_cast<std::uint64_t>((*numbers)[row]), out);
      } else if (const auto *integers = std::get_if<std::vector<std::int64_t>>(&cells)) {
        append_big_endian(static_cast<std::uint64_t>((*integers)[row]), out);
      } else if (const auto *flags = std::get_if<std::vector<bool>>(&cells)) {
        out += (*flags)[row] ? 'T' : 'F';
      } else {
        const std::string &text = std::get<std::vector<std::string>>(cells)[row];
        if (text.size() > widths_[c])
          return fail(ErrorCode::BadInput,
                      fmt::format("column {}: \"{}\" is longer than the {} characters of the "
                                  "first rows; write CSV instead",
                                  table.columns()[c].name, text, widths_[c]));
        out += text;
        out.append(widths_[c] - text.size(), '\0');
      }
    }
  return {};
}

Result<void> FitsTable::append(std::size_t rows, const std::string &bytes) {
  int status = 0;
  // CFITSIO does not change the bytes, though its interface is not const.
  auto *data = reinterpret_cast<unsigned char *>(const_cast<char *>(bytes.data()));
  fits_write_tblbytes(as_fits(file_), rows_ + 1, 1, static_cast<LONGLONG>(bytes.size()), data,
                      &status);
  if (written_)
    written_->add(bytes);
  rows_ += static_cast<long long>(rows);
  return check(status, "write rows");
}

Result<void> FitsTable::note(const std::string &text) {
  int status = 0;
  fits_write_comment(as_fits(file_), printable(text).c_str(), &status);
  return check(status, "write the header");
}

Result<void> FitsTable::close() {
  int status = 0;
  fitsfile *file = as_fits(std::exchange(file_, nullptr));
  if (!written_) {
    fits_close_file(file, &status);
    return check(status, "finish the file");
  }
  written_->close(file, status);
  UMOV_TRY(check(status, "finish the file"));
  if (!written_->stands_in(path_))
    return fail(ErrorCode::Device,
                fmt::format("cannot finish the file: {} Choose another folder or free some space.",
                            fits_is_incomplete),
                {path_.string()});
  return {};
}

Result<std::string> FitsTable::take() {
  int status = 0;
  LONGLONG header = 0, data = 0, end = 0;
  fits_flush_file(as_fits(file_), &status);
  fits_get_hduaddrll(as_fits(file_), &header, &data, &end, &status);
  UMOV_TRY(close());
  UMOV_TRY(check(status, "finish the file"));
  return std::string(static_cast<const char *>(memory_->bytes), static_cast<std::size_t>(end));
}

Result<std::string> to_fits(const Table &given) {
  const Table table = with_light_curve(given);
  UMOV_ASSIGN(file, FitsTable::create_in_memory(table));
  std::string bytes;
  UMOV_TRY(file.encode(table, 0, table.rows(), bytes));
  if (table.rows() > 0)
    UMOV_TRY(file.append(table.rows(), bytes));
  return file.take();
}

} // namespace umov
