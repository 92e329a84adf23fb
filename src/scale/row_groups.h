#pragma once
// Private: rows by the cells of some columns.

#include <optional>
#include <string>
#include <umov/io/table.h>
#include <unordered_map>
#include <utility>
#include <vector>

namespace umov::scale {

Cells none_like(const Cells &cells);
/// Usage for a name that the rows do not have.
Result<const Column *> column_of(const Table &rows, const std::string &name);

/// Which rows belong together. They stand in the order of their first rows in the whole table:
/// those of least order, and the earliest of them.
class Groups {
public:
  explicit Groups(std::optional<std::vector<std::string>> by) : by_(std::move(by)) {}

  /// Finds the columns in rows that are to be asked for. Usage for what they do not have.
  Result<void> look_at(const Table &rows);
  /// That of a row of the table that was looked at last; rows come as they are made.
  std::size_t of(std::size_t row, double order);
  [[nodiscard]] std::size_t count() const { return firsts_.size(); }
  /// Of the columns.
  [[nodiscard]] std::string names() const;
  [[nodiscard]] double first_order(std::size_t group) const { return firsts_[group].order; }
  [[nodiscard]] std::vector<std::size_t> in_order() const;
  /// Columns with the cells of each group in order, `times` over.
  void add_to(Table &out, std::size_t times) const;

private:
  /// count(): it is of none.
  [[nodiscard]] std::size_t find(std::size_t row) const;
  [[nodiscard]] std::size_t hash_of(std::size_t row) const;
  [[nodiscard]] bool is(std::size_t group, std::size_t row) const;
  /// Of two with rows of the same least order that whose row came earlier is before.
  struct First {
    double order;
    std::size_t turn;
  };
  std::optional<std::vector<std::string>> by_;
  std::vector<Column> keys_;           ///< cells by group
  std::vector<const Cells *> columns_; ///< of the rows at hand
  std::vector<First> firsts_;          ///< by group
  std::unordered_multimap<std::size_t, std::size_t> by_hash_;
  std::size_t last_ = 0, turn_ = 0;
};

} // namespace umov::scale
