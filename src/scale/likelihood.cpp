#include "scale/exact_sum.h"
#include "scale/grouped_reducer.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace umov::scale {
namespace {

/// A row farther off is in neither sum, so that none is of fewer rows than the other: 1.4 million
/// standard deviations.
constexpr double least_log = ExactSum::least / 2;
/// They are of some kilobytes each.
constexpr std::size_t most_groups = most_kept / 100;

/// How likely the measured values are if each row is as likely as any other. Sums are exact, so
/// that they do not depend on who added what to what.
class Likelihood final : public GroupedReducer {
public:
  Likelihood(Wanted wanted, std::string text)
      : GroupedReducer(std::move(wanted), std::move(text)) {}

  Result<void> take(const Table &rows, std::span<const double> order) override {
    UMOV_TRY(look_at(rows, order));
    std::vector<double> logs(rows.rows(), 0);
    for (const Measured &one : wanted_.measured) {
      UMOV_ASSIGN(values, numbers_of(rows, one.column));
      for (std::size_t row = 0; row < values.size(); ++row) {
        const double z = (values[row] - one.value) / one.error;
        logs[row] -= z * z / 2;
      }
    }
    rows_ += rows.rows();
    for (std::size_t row = 0; row < logs.size(); ++row) {
      Sums *sums = sums_of(row, order_at(order, row));
      if (sums == nullptr)
        return are_too_many(most_groups);
      ++sums->count;
      const double log =
          logs[row] < least_log ? -std::numeric_limits<double>::infinity() : logs[row];
      sums->of_one.add_exp(log);
      sums->of_squares.add_exp(2 * log);
    }
    return {};
  }
  Result<void> join(const Table &kept) override {
    UMOV_TRY(count_rows_of(kept));
    const std::vector<double> first = hidden(kept, first_column);
    UMOV_TRY(look_at(kept, first));
    const auto *counts = cells_of<std::int64_t>(kept, "count");
    const auto *ones = cells_of<std::string>(kept, sum_column);
    const auto *squares = cells_of<std::string>(kept, squares_column);
    if (counts == nullptr || ones == nullptr || squares == nullptr)
      return is_none();
    for (std::size_t row = 0; row < counts->size(); ++row) {
      Sums *sums = sums_of(row, order_at(first, row));
      if (sums == nullptr)
        return are_too_many(most_groups);
      sums->count += (*counts)[row];
      if (!sums->of_one.add((*ones)[row]) || !sums->of_squares.add((*squares)[row]))
        return is_none();
    }
    return {};
  }
  [[nodiscard]] Table kept() override {
    std::vector<std::int64_t> counts;
    std::vector<double> likelihood, effective, first;
    std::vector<std::string> ones, squares;
    for (const std::size_t group : groups_.in_order()) {
      const Sums &sums = sums_[group];
      counts.push_back(sums.count);
      const double log_sum = sums.of_one.log();
      likelihood.push_back(log_sum - std::log(static_cast<double>(sums.count)) - log_area());
      effective.push_back(std::exp(2 * log_sum - sums.of_squares.log()));
      ones.push_back(sums.of_one.text());
      squares.push_back(sums.of_squares.text());
      first.push_back(groups_.first_order(group));
    }
    Table out;
    for (const auto &[key, value] : about_.notes())
      out.note(key, value);
    add_notes(out);
    groups_.add_to(out, 1);
    out.add("count", "", "rows", std::move(counts));
    out.add("log_likelihood", "",
            "natural logarithm of the mean over the rows of the normal density of the measured "
            "values, in their units; 0 of rows without a value; not defined: all are; -inf: all "
            "others are more than a million standard deviations off",
            std::move(likelihood));
    out.add("effective_rows", "",
            "(sum of likelihoods)^2 / sum of their squares: on how many rows it rests; not "
            "defined where all are 0",
            std::move(effective));
    out.add(sum_column, "", "exact sum of the likelihoods", std::move(ones));
    out.add(squares_column, "", "exact sum of their squares", std::move(squares));
    if (has_order_)
      out.add(first_column, "", "least order of the rows of the group", std::move(first));
    return out;
  }

private:
  struct Sums {
    std::int64_t count = 0;
    ExactSum of_one, of_squares;
  };
  template <class T> static const std::vector<T> *cells_of(const Table &kept, const char *name) {
    const Column *column = kept.find(name);
    return column == nullptr ? nullptr : std::get_if<std::vector<T>>(&column->cells);
  }
  /// Of the normal densities, by which their peaks are 1.
  [[nodiscard]] double log_area() const {
    double out = 0;
    for (const Measured &one : wanted_.measured)
      out += std::log(one.error * std::sqrt(2 * std::numbers::pi));
    return out;
  }
  /// Null where the table would be too large.
  Sums *sums_of(std::size_t row, double order) {
    const std::size_t group = groups_.of(row, order);
    if (group == sums_.size()) {
      if (groups_.count() > most_groups)
        return nullptr;
      sums_.emplace_back();
    }
    return &sums_[group];
  }
  std::vector<Sums> sums_; ///< by group
};

} // namespace

std::unique_ptr<Reducer> make_likelihood(Wanted wanted, std::string text) {
  return std::make_unique<Likelihood>(std::move(wanted), std::move(text));
}

} // namespace umov::scale
