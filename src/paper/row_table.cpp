#include "paper/row_table.h"

namespace umov {

void RowTable::row(std::vector<Cell> cells) {
  for (std::size_t k = 0; k < columns_.size(); ++k)
    columns_[k].push_back(std::move(cells.at(k)));
}

Table RowTable::table() const {
  Table out;
  for (std::size_t k = 0; k < heads_.size(); ++k) {
    const std::vector<Cell> &column = columns_[k];
    const Head &head = heads_[k];
    if (!column.empty() && std::holds_alternative<std::string>(column.front())) {
      std::vector<std::string> cells;
      for (const Cell &cell : column)
        cells.push_back(std::get<std::string>(cell));
      out.add(head.name, head.unit, head.description, std::move(cells));
      continue;
    }
    std::vector<double> cells;
    for (const Cell &cell : column)
      cells.push_back(std::get<double>(cell));
    out.add(head.name, head.unit, head.description, std::move(cells));
  }
  note_conventions(out);
  return out;
}

} // namespace umov
