#include "scale/grouped_reducer.h"
#include "scale/picked_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace umov::scale {
namespace {

class Extremes final : public GroupedReducer {
public:
  Extremes(Wanted wanted, std::string text) : GroupedReducer(std::move(wanted), std::move(text)) {}

  Result<void> take(const Table &rows, std::span<const double> order) override {
    rows_ += rows.rows();
    return take_of(rows, order, order);
  }
  Result<void> join(const Table &kept) override {
    UMOV_TRY(count_rows_of(kept));
    return take_of(shown(kept), hidden(kept, order_column), hidden(kept, first_column));
  }
  [[nodiscard]] Table kept() override {
    Table out = about_;
    std::vector<double> order, first;
    for (const std::size_t group : groups_.in_order()) {
      Kept &one = kept_[group];
      cut(one);
      out.append(Table(one.rows));
      for (const Key &key : one.keys)
        order.push_back(key.order);
      first.insert(first.end(), one.keys.size(), groups_.first_order(group));
    }
    add_notes(out);
    if (has_order_) {
      out.add(order_column, "", "what rows are put in order by", std::move(order));
      out.add(first_column, "", "least order of the rows of the group", std::move(first));
    }
    return out;
  }

private:
  /// What rows are kept by: the value and, where that is the same, their place in the whole table.
  struct Key {
    double value, order;
  };
  struct Kept {
    Table rows;
    std::vector<Key> keys;
    std::optional<Key> bar; ///< what does not come before it is not kept
  };
  /// `first`: of the groups that the rows are of.
  Result<void> take_of(const Table &rows, std::span<const double> order,
                       std::span<const double> first) {
    UMOV_TRY(look_at(rows, order));
    UMOV_ASSIGN(values, numbers_of(rows, wanted_.column));
    std::vector<Key> keys;
    for (std::size_t row = 0; row < values.size(); ++row)
      keys.push_back({values[row], order_at(order, row)});
    std::vector<std::pair<std::size_t, std::size_t>> wanted; // of a group, a row
    for (std::size_t row = 0; row < values.size(); ++row) {
      if (std::isnan(values[row]))
        continue;
      const std::size_t group = groups_.of(row, order_at(first, row));
      kept_.resize(groups_.count());
      if (const auto &bar = kept_[group].bar; !bar || is_before(keys[row], *bar))
        wanted.emplace_back(group, row);
    }
    std::ranges::sort(wanted);
    for (auto begin = wanted.begin(); begin != wanted.end();) {
      std::vector<std::size_t> of_group;
      const std::size_t group = begin->first;
      for (; begin != wanted.end() && begin->first == group; ++begin)
        of_group.push_back(begin->second);
      add(kept_[group], rows, keys, std::move(of_group));
    }
    return all_kept_ > most_kept ? are_too_many(most_kept) : Result<void>();
  }
  [[nodiscard]] bool is_before(const Key &a, const Key &b) const {
    if (a.value == b.value)
      return a.order < b.order;
    return wanted_.kind == Kind::Most ? a.value > b.value : a.value < b.value;
  }
  /// The first by their keys, those that came earlier first where these are the same.
  void sort(std::vector<std::size_t> &rows, const std::vector<Key> &keys) const {
    std::ranges::stable_sort(
        rows, [&](std::size_t a, std::size_t b) { return is_before(keys[a], keys[b]); });
    rows.resize(std::min(rows.size(), wanted_.count));
  }
  void add(Kept &to, const Table &rows, const std::vector<Key> &keys,
           std::vector<std::size_t> &&wanted) {
    const std::size_t before = std::min(to.keys.size(), wanted_.count);
    sort(wanted, keys);
    for (const std::size_t row : wanted)
      to.keys.push_back(keys[row]);
    to.rows.append(picked(rows, wanted));
    all_kept_ += std::min(to.keys.size(), wanted_.count) - before;
    if (to.keys.size() > 2 * wanted_.count)
      cut(to);
  }
  void cut(Kept &one) const {
    std::vector<std::size_t> rows(one.keys.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    sort(rows, one.keys);
    if (rows.empty())
      return;
    one.rows = picked(one.rows, rows);
    std::vector<Key> keys;
    for (const std::size_t row : rows)
      keys.push_back(one.keys[row]);
    one.keys = std::move(keys);
    if (one.keys.size() == wanted_.count)
      one.bar = one.keys.back();
  }
  std::vector<Kept> kept_; ///< by group
  std::size_t all_kept_ = 0;
};

} // namespace

std::unique_ptr<Reducer> make_extremes(Wanted wanted, std::string text) {
  return std::make_unique<Extremes>(std::move(wanted), std::move(text));
}

} // namespace umov::scale
