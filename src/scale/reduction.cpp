#include <umov/scale/reduction.h>

#include "scale/picked_rows.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <umov/core/text.h>
#include <unordered_map>
#include <utility>

namespace umov::scale {
namespace {

constexpr std::size_t most_bins = 1'000'000, most_rows = 1'000'000;
/// Of a table: they stand in memory.
constexpr std::size_t most_kept = 10'000'000;

enum class Kind { Histogram, LogHistogram, Most, Least };
constexpr std::array<const char *, 4> kind_names{"histogram", "log-histogram", "most", "least"};

/// What a text asks for.
struct Wanted {
  Kind kind = Kind::Histogram;
  std::string column;
  double low = 0, high = 0;
  std::size_t count = 0;
  std::optional<std::vector<std::string>> by;
};

std::vector<std::string> split(const std::string &text, char at) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(at, begin);
    out.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return out;
}

/// One more than bins.
std::vector<double> edges_of(const Wanted &wanted) {
  const auto bins = static_cast<double>(wanted.count);
  std::vector<double> out;
  for (std::size_t k = 0; k <= wanted.count; ++k) {
    const double part = static_cast<double>(k) / bins;
    out.push_back(wanted.kind == Kind::LogHistogram
                      ? wanted.low * std::pow(wanted.high / wanted.low, part)
                      : wanted.low + (wanted.high - wanted.low) * part);
  }
  out.back() = wanted.high;
  return out;
}
bool are_edges(const std::vector<double> &edges) {
  return std::ranges::all_of(edges, [](double edge) { return std::isfinite(edge); }) &&
         std::ranges::adjacent_find(edges, std::greater_equal()) == edges.end();
}

Result<Wanted> read_wanted(const std::string &text) {
  const auto refuse = [&text](const std::string &why) {
    return fail(ErrorCode::Usage,
                fmt::format("--reduce {}: {}. Expected: histogram:COLUMN:LOW:HIGH:BINS, the same "
                            "with log-histogram, most:COLUMN:COUNT or least:COLUMN:COUNT, and "
                            ":COLUMN behind it for one of each of its values; such as "
                            "log-histogram:intensity:1e-6:100:80",
                            printable(text), why));
  };
  const std::vector<std::string> words = split(text, ':');
  const auto name = std::ranges::find(kind_names, words.front());
  if (name == kind_names.end())
    return refuse("no such reduction");
  Wanted out;
  out.kind = static_cast<Kind>(name - kind_names.begin());
  const bool is_histogram = out.kind == Kind::Histogram || out.kind == Kind::LogHistogram;
  const std::size_t least = is_histogram ? 5 : 3;
  if (words.size() < least || words.size() > least + 1 ||
      std::ranges::any_of(words, [](const std::string &word) { return word.empty(); }))
    return refuse(is_histogram ? "a column, two numbers and a number of bins"
                               : "a column and a number of rows");
  out.column = words[1];
  const std::string &count = words[least - 1];
  const auto end = count.data() + count.size();
  if (std::from_chars(count.data(), end, out.count).ptr != end || out.count == 0 ||
      out.count > (is_histogram ? most_bins : most_rows))
    return refuse("\"" + printable(count) + "\" is no number from 1 to a million");
  if (is_histogram) {
    const auto low = parse_number(words[2]), high = parse_number(words[3]);
    if (!low || !high || !(*low < *high) || (out.kind == Kind::LogHistogram && !(*low > 0)))
      return refuse(out.kind == Kind::LogHistogram ? "0 < LOW < HIGH" : "LOW < HIGH");
    out.low = *low, out.high = *high;
    if (!are_edges(edges_of(out)))
      return refuse("LOW and HIGH are too far apart, or too near for so many bins: the edges "
                    "between them are no rising numbers");
  }
  if (words.size() > least)
    out.by = split(words[least], '+');
  return out;
}

bool same_cell(const Cells &a, std::size_t i, const Cells &b, std::size_t k) {
  return std::visit(
      [&](const auto &cells) {
        const auto *others = std::get_if<std::decay_t<decltype(cells)>>(&b);
        return others != nullptr && cells[i] == (*others)[k];
      },
      a);
}
std::size_t hash_of_cell(const Cells &cells, std::size_t row) {
  return std::visit(
      [row](const auto &of) {
        return std::hash<typename std::decay_t<decltype(of)>::value_type>()(of[row]);
      },
      cells);
}
void push_cell(Cells &to, const Cells &from, std::size_t row) {
  std::visit(
      [&](auto &cells) { cells.push_back(std::get<std::decay_t<decltype(cells)>>(from)[row]); },
      to);
}
Cells none_like(const Cells &cells) {
  return std::visit([](const auto &like) -> Cells { return std::decay_t<decltype(like)>{}; },
                    cells);
}

/// Which rows belong together. They stand in the order of their first rows in the whole table:
/// those of least order, and the earliest of them.
class Groups {
public:
  explicit Groups(std::optional<std::vector<std::string>> by) : by_(std::move(by)) {}

  /// Finds the columns in rows that are to be asked for. Usage for what they do not have.
  Result<void> look_at(const Table &rows) {
    if (!by_)
      by_ = rows.find("band") != nullptr ? std::vector<std::string>{"band"}
                                         : std::vector<std::string>{};
    columns_.clear();
    for (const std::string &name : *by_) {
      UMOV_ASSIGN(column, column_of(rows, name));
      if (std::holds_alternative<std::vector<double>>(column->cells))
        return fail(ErrorCode::Usage,
                    fmt::format("--reduce of each {}: it is a column of numbers with a fraction; "
                                "one of texts or whole numbers was expected",
                                printable(name)));
      if (keys_.size() < by_->size())
        keys_.push_back(
            {column->name, column->unit, column->description, none_like(column->cells)});
      columns_.push_back(&column->cells);
    }
    return {};
  }
  /// That of a row of the table that was looked at last; rows come as they are made.
  std::size_t of(std::size_t row, double order) {
    const std::size_t group = find(row);
    if (group == firsts_.size()) {
      for (std::size_t c = 0; c < columns_.size(); ++c)
        push_cell(keys_[c].cells, *columns_[c], row);
      by_hash_.emplace(hash_of(row), group);
      firsts_.push_back({order, turn_++});
    } else if (order < firsts_[group].order) {
      firsts_[group] = {order, turn_++};
    }
    return last_ = group;
  }
  [[nodiscard]] std::size_t count() const { return firsts_.size(); }
  [[nodiscard]] std::string names() const {
    return printable(fmt::format("{}", fmt::join(*by_, "+")));
  }
  [[nodiscard]] double first_order(std::size_t group) const { return firsts_[group].order; }
  [[nodiscard]] std::vector<std::size_t> in_order() const {
    std::vector<std::size_t> out(count());
    std::iota(out.begin(), out.end(), std::size_t{0});
    std::ranges::sort(out, {}, [this](std::size_t group) {
      return std::pair{firsts_[group].order, firsts_[group].turn};
    });
    return out;
  }
  /// Columns with the cells of each group in order, `times` over.
  void add_to(Table &out, std::size_t times) const {
    const std::vector<std::size_t> groups = in_order();
    for (const Column &key : keys_) {
      Cells cells = none_like(key.cells);
      for (const std::size_t group : groups)
        for (std::size_t k = 0; k < times; ++k)
          push_cell(cells, key.cells, group);
      out.add(key.name, key.unit, key.description, std::move(cells));
    }
  }
  static Result<const Column *> column_of(const Table &rows, const std::string &name) {
    if (const Column *column = rows.find(name))
      return column;
    std::vector<std::string> known;
    for (const Column &column : rows.columns())
      known.push_back(column.name);
    return fail(ErrorCode::Usage, fmt::format("--reduce: the rows have no column {}; there are {}",
                                              printable(name), fmt::join(known, ", ")));
  }

private:
  /// count(): it is of none.
  [[nodiscard]] std::size_t find(std::size_t row) const {
    // Rows of bands take turns, those of objects follow each other.
    for (const std::size_t guess : {last_ + 1 < count() ? last_ + 1 : 0, last_})
      if (guess < count() && is(guess, row))
        return guess;
    const auto [begin, end] = by_hash_.equal_range(hash_of(row));
    const auto found =
        std::find_if(begin, end, [this, row](const auto &one) { return is(one.second, row); });
    return found == end ? count() : found->second;
  }
  [[nodiscard]] std::size_t hash_of(std::size_t row) const {
    std::size_t out = 0;
    for (const Cells *column : columns_)
      out = out * 31 + hash_of_cell(*column, row);
    return out;
  }
  [[nodiscard]] bool is(std::size_t group, std::size_t row) const {
    for (std::size_t c = 0; c < columns_.size(); ++c)
      if (!same_cell(keys_[c].cells, group, *columns_[c], row))
        return false;
    return true;
  }
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

/// The cells of a column of numbers.
Result<std::vector<double>> numbers_of(const Table &rows, const std::string &name) {
  UMOV_ASSIGN(column, Groups::column_of(rows, name));
  if (const auto *numbers = std::get_if<std::vector<double>>(&column->cells))
    return *numbers;
  if (const auto *counts = std::get_if<std::vector<std::int64_t>>(&column->cells))
    return std::vector<double>(counts->begin(), counts->end());
  return fail(ErrorCode::Usage,
              fmt::format("--reduce: column {} is no column of numbers", printable(name)));
}

/// Of rows where they stand by a column, and of their groups: in what shards keep, and in nothing
/// that is shown.
constexpr const char *order_column = "_order", *first_column = "_first";
constexpr const char *reduction_note = "reduction", *rows_note = "rows_reduced";

std::vector<double> hidden(const Table &kept, const char *name) {
  const Column *column = kept.find(name);
  const auto *cells =
      column == nullptr ? nullptr : std::get_if<std::vector<double>>(&column->cells);
  return cells == nullptr ? std::vector<double>{} : *cells;
}
Table shown(const Table &kept) {
  Table out = kept;
  out.remove(order_column);
  out.remove(first_column);
  return out;
}
double order_at(std::span<const double> order, std::size_t row) {
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
  Result<void> look_at(const Table &rows, std::span<const double> order) {
    UMOV_TRY(groups_.look_at(rows));
    has_order_ = has_order_ || !order.empty();
    if (about_.columns().empty())
      about_ = about(rows);
    return {};
  }
  Result<void> count_rows_of(const Table &kept) {
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
  [[nodiscard]] Result<void> is_none() const {
    return fail(ErrorCode::BadInput, "what was kept of a shard is no " + text_);
  }
  [[nodiscard]] Result<void> are_too_many() const {
    return fail(ErrorCode::BadInput,
                fmt::format("--reduce {}: its table has more than {} rows, with {} values of {}; "
                            "fewer of each, or columns with fewer values behind it, were expected",
                            printable(text_), most_kept, groups_.count(), groups_.names()));
  }
  void add_notes(Table &out) const {
    out.note(reduction_note, text_);
    out.note(rows_note, std::to_string(rows_));
  }
  const Wanted wanted_;
  const std::string text_;
  Groups groups_;
  bool has_order_ = false;
  std::size_t rows_ = 0;
  Table about_; ///< the columns of the first rows, and what is noted of them

private:
  static Table about(const Table &rows) {
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
};

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
        return are_too_many();
    return {};
  }
  Result<void> join(const Table &kept) override {
    UMOV_TRY(count_rows_of(kept));
    const std::vector<double> first = hidden(kept, first_column);
    UMOV_TRY(begin(kept, first, "low"));
    UMOV_ASSIGN(column, Groups::column_of(kept, "count"));
    const auto *counts = std::get_if<std::vector<std::int64_t>>(&column->cells);
    if (counts == nullptr || counts->size() % rows_of_group() != 0)
      return is_none();
    for (std::size_t row = 0; row < counts->size(); row += rows_of_group()) {
      auto *all = counts_of(row, order_at(first, row));
      if (all == nullptr)
        return are_too_many();
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
      UMOV_ASSIGN(values, Groups::column_of(rows, column));
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
    return all_kept_ > most_kept ? are_too_many() : Result<void>();
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

/// Hands the rows of the first table to all who keep something of them.
class KeptRows final : public jobs::RangeSink {
public:
  KeptRows(std::vector<std::unique_ptr<Reducer>> &to, std::string by, jobs::RangeSink &sink)
      : to_(to), by_(std::move(by)), sink_(sink) {}
  Result<void> add(std::size_t table, Table &&rows) override {
    if (table != 0)
      return {};
    const std::vector<double> order =
        by_.empty() ? std::vector<double>{} : hidden(rows, by_.c_str());
    rows.remove(by_);
    for (const auto &one : to_)
      UMOV_TRY(one->take(rows, order));
    return {};
  }
  void tally(const std::vector<std::size_t> &counts) override { sink_.tally(counts); }

private:
  std::vector<std::unique_ptr<Reducer>> &to_;
  const std::string by_; ///< RangedJob::order
  jobs::RangeSink &sink_;
};

class Reduced final : public jobs::RangedJob {
public:
  Reduced(std::unique_ptr<jobs::RangedJob> job, std::vector<std::string> texts)
      : job_(std::move(job)), texts_(std::move(texts)) {}
  [[nodiscard]] std::string unit() const override { return job_->unit(); }
  [[nodiscard]] std::size_t total() const override { return job_->total(); }
  [[nodiscard]] std::size_t grain() const override { return job_->grain(); }
  [[nodiscard]] bool is_reduced() const override { return true; }
  [[nodiscard]] std::string identity() const override {
    return job_->identity() + fmt::format("reduced to {}\n", fmt::join(texts_, " and "));
  }
  [[nodiscard]] std::vector<std::size_t> layout() const override { return job_->layout(); }
  [[nodiscard]] std::vector<std::string> tables() const override {
    std::vector<std::string> out;
    for (const std::string &text : texts_)
      out.push_back(reduced_name(text));
    return out;
  }
  [[nodiscard]] std::string nothing() const override { return job_->nothing(); }
  [[nodiscard]] std::vector<std::string> warnings() const override { return job_->warnings(); }
  [[nodiscard]] std::vector<jobs::Tally> tallies() const override { return job_->tallies(); }
  Result<void> rows(jobs::IndexRange range, jobs::RangeSink &sink, const jobs::Monitor &monitor,
                    Diagnostics &diagnostics) override {
    std::vector<std::unique_ptr<Reducer>> all;
    for (const std::string &text : texts_) {
      UMOV_ASSIGN(one, make_reducer(text));
      all.push_back(std::move(one));
    }
    KeptRows kept(all, job_->order(), sink);
    UMOV_TRY(job_->rows(range, kept, monitor, diagnostics));
    for (std::size_t k = 0; k < all.size(); ++k)
      UMOV_TRY(sink.add(k, all[k]->kept()));
    return {};
  }
  [[nodiscard]] Result<void> keep() override { return job_->keep(); }

private:
  std::unique_ptr<jobs::RangedJob> job_;
  std::vector<std::string> texts_;
};

} // namespace

Result<std::unique_ptr<Reducer>> make_reducer(const std::string &text) {
  UMOV_ASSIGN(wanted, read_wanted(text));
  if (wanted.kind == Kind::Histogram || wanted.kind == Kind::LogHistogram)
    return std::make_unique<Histogram>(std::move(wanted), text);
  return std::make_unique<Extremes>(std::move(wanted), text);
}

std::string reduced_name(const std::string &text) {
  const std::size_t kind = text.find(':'), column = text.find(':', kind + 1);
  std::string out = text.substr(0, column);
  std::ranges::replace_if(
      out, [](char c) { return c == ':' || c == '-'; }, '_');
  return out;
}

Result<void> check_reductions(const std::vector<std::string> &texts) {
  std::set<std::string> names;
  for (const std::string &text : texts) {
    UMOV_TRY(read_wanted(text));
    if (!names.insert(reduced_name(text)).second)
      return fail(ErrorCode::Usage, fmt::format("--reduce {}: there is one of that kind and column "
                                                "already; another job takes the other",
                                                printable(text)));
  }
  return {};
}

Result<std::unique_ptr<jobs::RangedJob>> reduced_job(std::unique_ptr<jobs::RangedJob> job,
                                                     const std::vector<std::string> &texts) {
  UMOV_TRY(check_reductions(texts));
  if (texts.empty())
    return std::move(job);
  if (!job->problems().empty())
    return fail(ErrorCode::Usage,
                "--reduce: the rows of this verb are answers of curves, which are few and kept "
                "whole. Leave it out.");
  return std::make_unique<Reduced>(std::move(job), texts);
}

} // namespace umov::scale
