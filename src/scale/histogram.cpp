#include "scale/grouped_reducer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace umov::scale {
namespace {

class Histogram final : public GroupedReducer {
public:
  Histogram(Wanted wanted, std::string text)
      : GroupedReducer(std::move(wanted), std::move(text)), edges_(edges_of(wanted_)) {}
  Result<void> take(const Table &rows, std::span<const double> order) override {
    UMOV_TRY(begin(rows, order, wanted_.column));
    UMOV_ASSIGN(values, numbers_of(rows, wanted_.column));
    rows_ += values.size();
    for (std::size_t row = 0; row < values.size(); ++row)
      if (auto *counts = counts_of(row, order_at(order, row)))
        ++(*counts)[bin_of(values[row])];
      else
        return are_too_many(most_kept);
    return {};
  }
  Result<void> join(const Table &kept) override {
    UMOV_TRY(count_rows_of(kept));
    const std::vector<double> first = hidden(kept, first_column);
    UMOV_TRY(begin(kept, first, "low"));
    UMOV_ASSIGN(column, column_of(kept, "count"));
    const auto *counts = std::get_if<std::vector<std::int64_t>>(&column->cells);
    if (counts == nullptr || counts->size() % rows_of_group() != 0)
      return is_none();
    for (std::size_t row = 0; row < counts->size(); row += rows_of_group()) {
      auto *all = counts_of(row, order_at(first, row));
      if (all == nullptr)
        return are_too_many(most_kept);
      for (std::size_t k = 0; k < all->size(); ++k)
        (*all)[k] += (*counts)[row + k];
    }
    return {};
  }
  [[nodiscard]] Table kept() override {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> low, high, first;
    std::vector<std::int64_t> counts;
    for (const std::size_t group : groups_.in_order()) {
      low.insert(low.end(), edges_.begin(), edges_.end() - 1);
      high.insert(high.end(), edges_.begin() + 1, edges_.end());
      low.insert(low.end(), {nan, wanted_.high, nan});
      high.insert(high.end(), {wanted_.low, nan, nan});
      counts.insert(counts.end(), counts_[group].begin(), counts_[group].end());
      first.insert(first.end(), rows_of_group(), groups_.first_order(group));
    }
    Table out;
    for (const auto &[key, value] : about_.notes())
      out.note(key, value);
    add_notes(out);
    groups_.add_to(out, rows_of_group());
    out.add("low", unit_, "least value of the bin; not defined: all below `high`", std::move(low));
    out.add("high", unit_,
            "end of the bin, which belongs to the next; not defined: all from `low` on; both not "
            "defined: rows without a value",
            std::move(high));
    out.add("count", "", "rows with a value in the bin", std::move(counts));
    if (has_order_)
      out.add(first_column, "", "least order of the rows of the group", std::move(first));
    return out;
  }

private:
  [[nodiscard]] bool is_log() const { return wanted_.kind == Kind::LogHistogram; }
  /// Bins, those below, those above, those without a value.
  [[nodiscard]] std::size_t rows_of_group() const { return wanted_.count + 3; }
  Result<void> begin(const Table &rows, std::span<const double> order, const std::string &column) {
    UMOV_TRY(look_at(rows, order));
    if (!std::exchange(has_unit_, true)) {
      UMOV_ASSIGN(values, column_of(rows, column));
      unit_ = values->unit;
    }
    return {};
  }
  /// Null where the table would be too large.
  std::vector<std::int64_t> *counts_of(std::size_t row, double order) {
    const std::size_t group = groups_.of(row, order);
    if (group == counts_.size()) {
      if (groups_.count() * rows_of_group() > most_kept)
        return nullptr;
      counts_.emplace_back(rows_of_group());
    }
    return &counts_[group];
  }
  /// The edges decide, whatever the last digit of a logarithm is.
  [[nodiscard]] std::size_t bin_of(double value) const {
    if (std::isnan(value))
      return wanted_.count + 2;
    if (value < wanted_.low)
      return wanted_.count;
    if (value >= wanted_.high)
      return wanted_.count + 1;
    const double part = is_log()
                            ? std::log(value / wanted_.low) / std::log(wanted_.high / wanted_.low)
                            : (value - wanted_.low) / (wanted_.high - wanted_.low);
    auto bin = std::min(static_cast<std::size_t>(part * static_cast<double>(wanted_.count)),
                        wanted_.count - 1);
    while (value < edges_[bin])
      --bin;
    while (value >= edges_[bin + 1])
      ++bin;
    return bin;
  }
  const std::vector<double> edges_;
  std::vector<std::vector<std::int64_t>> counts_; ///< by group
  bool has_unit_ = false;
  std::string unit_;
};

} // namespace

std::unique_ptr<Reducer> make_histogram(Wanted wanted, std::string text) {
  return std::make_unique<Histogram>(std::move(wanted), std::move(text));
}

} // namespace umov::scale
