#include <umov/io/table.h>

#include <algorithm>
#include <cmath>
#include <fmt/ranges.h>
#include <limits>
#include <umov/core/text.h>
#include <umov/core/version.h>

namespace umov {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Resize {
  std::size_t rows;
  void operator()(std::vector<double> &cells) const { cells.resize(rows, nan); }
  template <class T> void operator()(std::vector<T> &cells) const { cells.resize(rows); }
};

struct AsNumber {
  std::size_t row;
  double operator()(const std::vector<double> &cells) const { return cells[row]; }
  double operator()(const std::vector<std::int64_t> &cells) const {
    return static_cast<double>(cells[row]);
  }
  double operator()(const std::vector<std::string> &) const { return nan; }
  double operator()(const std::vector<bool> &cells) const { return cells[row] ? 1 : 0; }
};

struct AsText {
  std::size_t row;
  std::string operator()(const std::vector<double> &cells) const {
    return std::isnan(cells[row]) ? "" : shortest(cells[row]);
  }
  std::string operator()(const std::vector<std::int64_t> &cells) const {
    return std::to_string(cells[row]);
  }
  std::string operator()(const std::vector<std::string> &cells) const { return cells[row]; }
  std::string operator()(const std::vector<bool> &cells) const {
    return cells[row] ? "True" : "False";
  }
};

} // namespace

void Table::add(std::string name, std::string unit, std::string description, Cells cells) {
  if (columns_.empty())
    rows_ = std::visit([](const auto &c) { return c.size(); }, cells);
  std::visit(Resize{rows_}, cells);
  columns_.push_back(
      {std::move(name), std::move(unit), std::move(description), std::move(cells), {}});
}

void Table::set_precision(std::string_view name, Precision precision) {
  for (Column &column : columns_)
    if (column.name == name)
      column.precision = precision;
}

void Table::set_width(std::string_view name, std::size_t width) {
  for (Column &column : columns_)
    if (column.name == name)
      column.width = width;
}

void Table::clear_precision() {
  for (Column &column : columns_)
    column.precision = {};
}

void Table::note(std::string key, std::string value) {
  notes_.emplace_back(std::move(key), std::move(value));
}

const Column *Table::find(std::string_view name) const {
  for (const Column &column : columns_)
    if (column.name == name)
      return &column;
  return nullptr;
}

double Table::number(std::string_view name, std::size_t row) const {
  const Column *column = find(name);
  return column && row < rows_ ? std::visit(AsNumber{row}, column->cells) : nan;
}

void Table::append(Table &&rows) {
  if (columns_.empty()) {
    *this = std::move(rows);
    return;
  }
  for (std::size_t c = 0; c < columns_.size(); ++c)
    std::visit(
        [&](auto &cells) {
          const auto &more = std::get<std::decay_t<decltype(cells)>>(rows.columns_[c].cells);
          cells.insert(cells.end(), more.begin(), more.end());
        },
        columns_[c].cells);
  rows_ += rows.rows_;
}

Table Table::part(std::size_t first, std::size_t count) const {
  Table out;
  out.notes_ = notes_;
  out.rows_ = count;
  const auto begin = static_cast<std::ptrdiff_t>(first);
  const auto end = static_cast<std::ptrdiff_t>(first + count);
  for (const Column &column : columns_)
    out.columns_.push_back({column.name, column.unit, column.description,
                            std::visit(
                                [&](const auto &cells) -> Cells {
                                  return std::decay_t<decltype(cells)>(cells.begin() + begin,
                                                                       cells.begin() + end);
                                },
                                column.cells),
                            column.precision});
  return out;
}

void Table::remove(std::string_view name) {
  std::erase_if(columns_, [name](const Column &column) { return column.name == name; });
}

Result<Table> with_columns(const Table &table, const std::vector<std::string> &names) {
  Table out;
  for (const std::string &name : names) {
    const Column *column = table.find(name);
    if (column == nullptr) {
      std::vector<std::string> known;
      for (const Column &one : table.columns())
        known.push_back(one.name);
      const auto near = nearest_name(name, known);
      return fail(ErrorCode::Usage,
                  fmt::format("no column \"{}\".{} There are: {}", name,
                              near ? fmt::format(" Did you mean \"{}\"?", *near) : "",
                              fmt::join(known, ", ")));
    }
    out.add(column->name, column->unit, column->description, column->cells);
  }
  for (const auto &[key, value] : table.notes())
    out.note(key, value);
  return out;
}

namespace {

struct IsEmpty {
  bool operator()(const std::vector<double> &cells) const {
    return std::ranges::all_of(cells, [](double v) { return std::isnan(v); });
  }
  bool operator()(const std::vector<std::string> &cells) const {
    return std::ranges::all_of(cells, [](const std::string &text) { return text.empty(); });
  }
  template <class Other> bool operator()(const Other &) const { return false; }
};

} // namespace

Table without_empty_columns(const Table &table) {
  Table out;
  for (const Column &column : table.columns())
    if (table.rows() == 0 || !std::visit(IsEmpty{}, column.cells))
      out.add(column.name, column.unit, column.description, column.cells);
  for (const auto &[key, value] : table.notes())
    out.note(key, value);
  return out;
}

std::string Table::text(std::string_view name, std::size_t row) const {
  const Column *column = find(name);
  return column && row < rows_ ? std::visit(AsText{row}, column->cells) : "";
}

void note_conventions(Table &table) {
  table.note("umov_version", version);
  table.note("conventions_version", std::to_string(conventions_version));
  table.note("POLCCONV", "IAU");
  table.note("conventions",
             "Time: UTC. I: irradiance at the observer above the atmosphere; intensity: without "
             "distance and solar flux. q u v: fractions of I; sky frame: IAU, +Q north-south, +U "
             "north-east to south-west, position angles from north through east, V > 0 "
             "right-handed. q_scat u_scat: +Q perpendicular to the scattering plane; pa_scat: "
             "position angle of its normal. phase_angle: Sun-object-observer, 0 = full. qw qx qy "
             "qz: body_from_gcrs, scalar first. *_err: numerical 95 % half-widths.");
}

} // namespace umov
