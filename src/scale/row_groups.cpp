#include "scale/row_groups.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <numeric>
#include <umov/core/text.h>

namespace umov::scale {
namespace {

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

} // namespace

Cells none_like(const Cells &cells) {
  return std::visit([](const auto &like) -> Cells { return std::decay_t<decltype(like)>{}; },
                    cells);
}

Result<const Column *> column_of(const Table &rows, const std::string &name) {
  if (const Column *column = rows.find(name))
    return column;
  std::vector<std::string> known;
  for (const Column &column : rows.columns())
    known.push_back(column.name);
  return fail(ErrorCode::Usage, fmt::format("--reduce: the rows have no column {}; there are {}",
                                            printable(name), fmt::join(known, ", ")));
}

Result<void> Groups::look_at(const Table &rows) {
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
      keys_.push_back({column->name, column->unit, column->description, none_like(column->cells)});
    columns_.push_back(&column->cells);
  }
  return {};
}

std::size_t Groups::of(std::size_t row, double order) {
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

std::string Groups::names() const { return printable(fmt::format("{}", fmt::join(*by_, "+"))); }

std::vector<std::size_t> Groups::in_order() const {
  std::vector<std::size_t> out(count());
  std::iota(out.begin(), out.end(), std::size_t{0});
  std::ranges::sort(out, {}, [this](std::size_t group) {
    return std::pair{firsts_[group].order, firsts_[group].turn};
  });
  return out;
}

void Groups::add_to(Table &out, std::size_t times) const {
  const std::vector<std::size_t> groups = in_order();
  for (const Column &key : keys_) {
    Cells cells = none_like(key.cells);
    for (const std::size_t group : groups)
      for (std::size_t k = 0; k < times; ++k)
        push_cell(cells, key.cells, group);
    out.add(key.name, key.unit, key.description, std::move(cells));
  }
}

std::size_t Groups::find(std::size_t row) const {
  // Rows of bands take turns, those of objects follow each other.
  for (const std::size_t guess : {last_ + 1 < count() ? last_ + 1 : 0, last_})
    if (guess < count() && is(guess, row))
      return guess;
  const auto [begin, end] = by_hash_.equal_range(hash_of(row));
  const auto found =
      std::find_if(begin, end, [this, row](const auto &one) { return is(one.second, row); });
  return found == end ? count() : found->second;
}

std::size_t Groups::hash_of(std::size_t row) const {
  std::size_t out = 0;
  for (const Cells *column : columns_)
    out = out * 31 + hash_of_cell(*column, row);
  return out;
}

bool Groups::is(std::size_t group, std::size_t row) const {
  for (std::size_t c = 0; c < columns_.size(); ++c)
    if (!same_cell(keys_[c].cells, group, *columns_[c], row))
      return false;
  return true;
}

} // namespace umov::scale
