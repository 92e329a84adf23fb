#pragma once
#include <umov/io/table.h>
#include <variant>

namespace umov {

/// A table that grows row by row.
class RowTable {
public:
  struct Head {
    std::string name, unit, description;
  };
  using Cell = std::variant<double, std::string>;

  explicit RowTable(std::vector<Head> heads) : heads_(std::move(heads)), columns_(heads_.size()) {}
  /// As many cells as heads; a column holds text if its first cell does.
  void row(std::vector<Cell> cells);
  [[nodiscard]] Table table() const;

private:
  std::vector<Head> heads_;
  std::vector<std::vector<Cell>> columns_;
};

} // namespace umov
