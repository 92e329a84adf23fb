#include "scale/grouped_reducer.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov::scale {
namespace {

constexpr const char *reduction_note = "reduction", *rows_note = "rows_reduced";

/// The columns of rows without any row, and what is noted of them but what reducers note.
Table about(const Table &rows) {
  Table out;
  for (const auto &[key, value] : rows.notes())
    if (key != reduction_note && key != rows_note)
      out.note(key, value);
  for (const Column &column : rows.columns()) {
    out.add(column.name, column.unit, column.description, none_like(column.cells));
    out.set_precision(column.name, column.precision);
  }
  return out;
}

} // namespace

Result<std::vector<double>> numbers_of(const Table &rows, const std::string &name) {
  UMOV_ASSIGN(column, column_of(rows, name));
  if (const auto *numbers = std::get_if<std::vector<double>>(&column->cells))
    return *numbers;
  if (const auto *counts = std::get_if<std::vector<std::int64_t>>(&column->cells))
    return std::vector<double>(counts->begin(), counts->end());
  return fail(ErrorCode::Usage,
              fmt::format("--reduce: column {} is no column of numbers", printable(name)));
}

std::vector<double> hidden(const Table &kept, const char *name) {
  const Column *column = kept.find(name);
  const auto *cells =
      column == nullptr ? nullptr : std::get_if<std::vector<double>>(&column->cells);
  return cells == nullptr ? std::vector<double>{} : *cells;
}
Table shown(Table kept) {
  for (const char *name : {order_column, first_column, sum_column, squares_column})
    kept.remove(name);
  return kept;
}

Result<void> GroupedReducer::look_at(const Table &rows, std::span<const double> order) {
  UMOV_TRY(groups_.look_at(rows));
  has_order_ = has_order_ || !order.empty();
  if (about_.columns().empty())
    about_ = about(rows);
  return {};
}

Result<void> GroupedReducer::count_rows_of(const Table &kept) {
  const auto note = std::ranges::find(kept.notes(), std::string(rows_note),
                                      &std::pair<std::string, std::string>::first);
  std::size_t count = 0;
  if (note == kept.notes().end() ||
      std::from_chars(note->second.data(), note->second.data() + note->second.size(), count).ec !=
          std::errc())
    return is_none();
  rows_ += count;
  return {};
}

Result<void> GroupedReducer::is_none() const {
  return fail(ErrorCode::BadInput, "what was kept of a shard is no " + text_);
}

Result<void> GroupedReducer::are_too_many(std::size_t most) const {
  return fail(ErrorCode::BadInput,
              fmt::format("--reduce {}: its table has more than {} rows, with {} values of {}; "
                          "fewer of each, or columns with fewer values behind it, were expected",
                          printable(text_), most, groups_.count(), groups_.names()));
}

void GroupedReducer::add_notes(Table &out) const {
  out.note(reduction_note, text_);
  out.note(rows_note, std::to_string(rows_));
}

} // namespace umov::scale
