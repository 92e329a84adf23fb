#include "io/table/row_texts.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <system_error>
#include <umov/core/parallel.h>
#include <variant>
#include <vector>

namespace umov {
namespace {

using Numbers = std::vector<double>;

char delimiter_of(TextForm form) { return form == TextForm::Csv ? ',' : ' '; }

void append_quoted(std::string_view text, TextForm form, std::string &out) {
  const char special[] = {'"', '\r', '\n', '\t', ' ', delimiter_of(form)};
  const bool is_plain =
      !text.empty() && text.front() != '#' &&
      text.find_first_of(std::string_view(special, sizeof(special))) == std::string_view::npos;
  if (is_plain || (text.empty() && form == TextForm::Csv)) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    out += c;
    if (c == '"')
      out += c;
  }
  out += '"';
}

/// A text that a spreadsheet would take for a formula and compute: they take one with a ' before it
/// for text. A sign alone ("+X", "-2 deg") calls and refers to nothing.
bool is_formula(std::string_view text) {
  return text.starts_with('=') || text.starts_with('@') || text.starts_with('\t') ||
         ((text.starts_with('+') || text.starts_with('-')) &&
          text.find_first_of("(!|") != std::string_view::npos);
}

/// As `shortest` has it.
void append_shortest(double value, std::string &out) {
  char text[40];
  if (std::isnan(value))
    out += "nan"; // one spelling, whatever the sign bit
  else
    out.append(text,
               static_cast<std::size_t>(std::to_chars(text, std::end(text), value).ptr - text));
}

bool same_bits(const Numbers &numbers, std::size_t a, std::size_t b) {
  return std::bit_cast<std::uint64_t>(numbers[a]) == std::bit_cast<std::uint64_t>(numbers[b]);
}

/// The cells of a column as texts, row after row. Many are as in the row before, as poses are in
/// all bands: their text is taken from there.
class CellTexts {
public:
  CellTexts(const Table &table, const Column &column, TextForm form)
      : table_(table), column_(column), form_(form), numbers_(std::get_if<Numbers>(&column.cells)) {
    if (form == TextForm::Csv && column.precision != Precision{})
      precision_ = &column.precision;
    if (precision_ != nullptr && !precision_->error.empty())
      if (const Column *error = table.find(precision_->error))
        errors_ = std::get_if<Numbers>(&error->cells);
  }

  void append(std::size_t row, std::string &out) {
    const std::size_t at = out.size();
    if (is_begun_ && is_as_before(row))
      out.append(out, at_, length_);
    else
      write(row, out);
    is_begun_ = true;
    at_ = at;
    length_ = out.size() - at;
  }

private:
  [[nodiscard]] bool is_as_before(std::size_t row) const {
    if (numbers_ != nullptr)
      return same_bits(*numbers_, row - 1, row) &&
             (precision_ == nullptr || precision_->error.empty() ||
              (errors_ != nullptr && same_bits(*errors_, row - 1, row)));
    return std::visit([row](const auto &cells) { return cells[row - 1] == cells[row]; },
                      column_.cells);
  }
  void write(std::size_t row, std::string &out) const {
    if (numbers_ != nullptr) {
      const double value = (*numbers_)[row];
      if (form_ == TextForm::Ecsv || !std::isnan(value))
        append_shortest(precision_ == nullptr ? value : rounded(row, value), out);
    } else if (const auto *counts = std::get_if<std::vector<std::int64_t>>(&column_.cells)) {
      char text[24];
      out.append(text, static_cast<std::size_t>(
                           std::to_chars(text, std::end(text), (*counts)[row]).ptr - text));
    } else if (const auto *flags = std::get_if<std::vector<bool>>(&column_.cells)) {
      out += (*flags)[row] ? "True" : "False";
    } else {
      const std::string &text = std::get<std::vector<std::string>>(column_.cells)[row];
      if (form_ == TextForm::Csv && is_formula(text))
        append_quoted("'" + text, form_, out);
      else
        append_quoted(text, form_, out);
    }
  }
  /// With as many digits as the column is written with in this row.
  [[nodiscard]] double rounded(std::size_t row, double value) const {
    if (!std::isfinite(value) || value == 0)
      return value;
    int digits = precision_->significant;
    if (digits == 0) {
      int last = -precision_->decimals; // power of ten of the last digit
      if (!precision_->error.empty()) {
        const double error =
            errors_ == nullptr ? table_.number(precision_->error, row) : (*errors_)[row];
        if (!(error > 0) || !std::isfinite(error))
          return value;
        last = static_cast<int>(std::floor(std::log10(error))) - 1;
      }
      // Two digits of the value stay whatever its error is; ten are enough for those known exactly.
      const int first = static_cast<int>(std::floor(std::log10(std::abs(value))));
      digits = std::clamp(first - last + 1, 2, precision_->error.empty() ? 16 : 10);
    }
    char text[40];
    const auto [end, problem] =
        std::to_chars(text, std::end(text), value, std::chars_format::scientific, digits - 1);
    double out = value;
    if (problem == std::errc{}) // else more digits than any double has: all of them
      std::from_chars(text, end, out);
    return out;
  }

  const Table &table_;
  const Column &column_;
  const TextForm form_;
  const Numbers *numbers_, *errors_ = nullptr;
  const Precision *precision_ = nullptr; ///< null: all digits
  bool is_begun_ = false;
  std::size_t at_ = 0, length_ = 0; ///< of the row before, in what is written
};

} // namespace

std::string quoted_cell(const std::string &text, TextForm form) {
  std::string out;
  append_quoted(text, form, out);
  return out;
}

void append_rows(const Table &table, std::size_t begin, std::size_t end, TextForm form,
                 std::string &out) {
  std::vector<CellTexts> columns;
  for (const Column &column : table.columns())
    columns.emplace_back(table, column, form);
  const char delimiter = delimiter_of(form);
  for (std::size_t row = begin; row < end; ++row) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (c > 0)
        out += delimiter;
      columns[c].append(row, out);
    }
    out += '\n';
  }
}

Result<void> write_rows(FileInProgress &file, const Table &table, TextForm form, unsigned threads) {
  const std::size_t tasks = (table.rows() + rows_per_task - 1) / rows_per_task;
  const std::size_t at_once = std::min<std::size_t>(resolve_threads(threads), tasks);
  std::vector<std::string> texts(at_once);
  for (std::size_t first = 0; first < table.rows(); first += at_once * rows_per_task) {
    parallel_for(at_once, threads, [&](std::size_t k) {
      texts[k].clear();
      const std::size_t begin = std::min(table.rows(), first + k * rows_per_task);
      append_rows(table, begin, std::min(table.rows(), begin + rows_per_task), form, texts[k]);
    });
    for (const std::string &text : texts)
      UMOV_TRY(file.write(text));
  }
  return {};
}

} // namespace umov
