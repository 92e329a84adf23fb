#pragma once
// Private: rows of a table in another order, or some of them.

#include <umov/io/table.h>

namespace umov::scale {

/// Rows by their numbers, with all that is said of the table.
inline Table picked(const Table &table, const std::vector<std::size_t> &rows) {
  Table out;
  for (const auto &[key, value] : table.notes())
    out.note(key, value);
  for (const Column &column : table.columns()) {
    out.add(column.name, column.unit, column.description,
            std::visit(
                [&rows](const auto &cells) -> Cells {
                  std::decay_t<decltype(cells)> put;
                  put.reserve(rows.size());
                  for (const std::size_t row : rows)
                    put.push_back(cells[row]);
                  return put;
                },
                column.cells));
    out.set_precision(column.name, column.precision);
  }
  return out;
}

} // namespace umov::scale
