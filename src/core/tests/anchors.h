#pragma once
// Tables of tests/data/anchors: numbers that tools/anchors makes from the formulas of docs/theory.

#include <charconv>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace umov {

/// One row: keys as text, values as numbers.
class AnchorRow {
public:
  AnchorRow(const std::vector<std::string> &columns, std::vector<std::string> cells)
      : columns_(&columns), cells_(std::move(cells)) {}

  const std::string &text(const std::string &column) const {
    for (std::size_t i = 0; i < columns_->size(); ++i)
      if ((*columns_)[i] == column)
        return cells_.at(i);
    throw std::runtime_error("no column " + column);
  }
  double operator[](const std::string &column) const { return number(text(column)); }
  /// Half a unit of the last digit: how far the exact value may be from what is printed.
  double half_digit(const std::string &column) const {
    const std::string &cell = text(column);
    const std::size_t point = cell.find('.');
    return point == std::string::npos
               ? 0.5
               : 0.5 * std::pow(10., -static_cast<double>(cell.size() - point - 1));
  }
  const std::vector<std::string> &cells() const { return cells_; }
  static double number(const std::string &cell) {
    double out = 0;
    const auto read = std::from_chars(cell.data(), cell.data() + cell.size(), out);
    if (read.ptr != cell.data() + cell.size())
      throw std::runtime_error("not a number: " + cell);
    return out;
  }

private:
  const std::vector<std::string> *columns_;
  std::vector<std::string> cells_;
};

/// A whole table, in the order of the file.
class Anchors {
public:
  explicit Anchors(const std::string &name) {
    std::ifstream file(UMOV_SOURCE_DIR "/tests/data/anchors/" + name + ".csv");
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with('#'))
        continue;
      std::vector<std::string> cells;
      std::istringstream words(line);
      for (std::string cell; std::getline(words, cell, ',');)
        cells.push_back(cell);
      if (columns_.empty())
        columns_ = cells;
      else
        rows_.emplace_back(columns_, std::move(cells));
    }
    if (rows_.empty())
      throw std::runtime_error("no table of anchors: " + name);
  }
  Anchors(const Anchors &) = delete;
  Anchors &operator=(const Anchors &) = delete;

  auto begin() const { return rows_.begin(); }
  auto end() const { return rows_.end(); }
  std::size_t size() const { return rows_.size(); }
  /// The row that begins with these cells.
  const AnchorRow &row(std::initializer_list<const char *> keys) const {
    for (const AnchorRow &one : rows_)
      if (std::equal(keys.begin(), keys.end(), one.cells().begin()))
        return one;
    throw std::runtime_error("no such row of anchors");
  }

private:
  std::vector<std::string> columns_;
  std::vector<AnchorRow> rows_;
};

/// A number of a table of names and values.
inline double anchor(const std::string &name, const char *table = "singles") {
  return Anchors(table).row({name.c_str()})["value"];
}

/// Where a band of Table 1 stands among 425, 550, 650 nm.
inline std::size_t band_of(const AnchorRow &row) {
  return row.text("nm") == "425" ? 0 : row.text("nm") == "550" ? 1 : 2;
}

} // namespace umov
