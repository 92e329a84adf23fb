#pragma once
// Private: what histograms, extremes and likelihoods of groups have in common.

#include "scale/reduction_text.h"
#include "scale/row_groups.h"

#include <memory>
#include <span>
#include <umov/scale/reduction.h>

namespace umov::scale {

/// Of a table: they stand in memory.
inline constexpr std::size_t most_kept = 10'000'000;

/// The cells of a column of numbers.
Result<std::vector<double>> numbers_of(const Table &rows, const std::string &name);

/// Of rows where they stand by a column, and of their groups: in what shards keep, and in nothing
/// that is shown.
inline constexpr const char *order_column = "_order", *first_column = "_first";
/// Exact sums of a group, in what shards keep.
inline constexpr const char *sum_column = "_sum", *squares_column = "_squares";
/// The cells of such a column of numbers; none where there is none.
std::vector<double> hidden(const Table &kept, const char *name);
/// Without these columns.
Table shown(Table kept);
inline double order_at(std::span<const double> order, std::size_t row) {
  return order.empty() ? 0 : order[row];
}

/// What all have in common: of how many rows, and what is said of these.
class GroupedReducer : public Reducer {
public:
  [[nodiscard]] std::size_t rows() const override { return rows_; }
  [[nodiscard]] Table table() override { return shown(kept()); }

protected:
  GroupedReducer(Wanted wanted, std::string text)
      : wanted_(std::move(wanted)), text_(std::move(text)), groups_(wanted_.by) {}

  /// Rows that come, as they are made or as they were kept.
  Result<void> look_at(const Table &rows, std::span<const double> order);
  Result<void> count_rows_of(const Table &kept);
  [[nodiscard]] Result<void> is_none() const;
  /// Rows of its table, with so many expected at most.
  [[nodiscard]] Result<void> are_too_many(std::size_t most) const;
  void add_notes(Table &out) const;
  const Wanted wanted_;
  const std::string text_;
  Groups groups_;
  bool has_order_ = false;
  std::size_t rows_ = 0;
  Table about_; ///< the columns of the first rows, and what is noted of them
};

std::unique_ptr<Reducer> make_histogram(Wanted wanted, std::string text);
std::unique_ptr<Reducer> make_extremes(Wanted wanted, std::string text);
std::unique_ptr<Reducer> make_likelihood(Wanted wanted, std::string text);

} // namespace umov::scale
