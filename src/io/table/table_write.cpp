#include <umov/io/table.h>

#include "io/table/row_texts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace umov {

namespace {

/// A string as a YAML double-quoted scalar; JSON's form is one.
std::string quoted_yaml(const std::string &text) {
  return nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

const char *type_name(const Cells &cells) {
  constexpr const char *names[] = {"float64", "int64", "string", "bool"};
  return names[cells.index()];
}

bool is_numeric(const Cells &cells) { return cells.index() < 2; }

/// A note in one line, so that it cannot break out of a comment.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

nlohmann::ordered_json json_cell(const Column &column, std::size_t row) {
  if (const auto *numbers = std::get_if<std::vector<double>>(&column.cells))
    return std::isfinite((*numbers)[row]) ? nlohmann::ordered_json((*numbers)[row])
                                          : nlohmann::ordered_json(nullptr);
  if (const auto *integers = std::get_if<std::vector<std::int64_t>>(&column.cells))
    return (*integers)[row];
  if (const auto *flags = std::get_if<std::vector<bool>>(&column.cells))
    return static_cast<bool>((*flags)[row]);
  return std::get<std::vector<std::string>>(column.cells)[row];
}

std::string terminal_cell(const Table &table, const Column &column, std::size_t row) {
  if (const auto *numbers = std::get_if<std::vector<double>>(&column.cells))
    return std::isnan((*numbers)[row]) ? "-" : fmt::format("{:.6g}", (*numbers)[row]);
  return table.text(column.name, row);
}

} // namespace

std::string ecsv_header(const Table &table) {
  std::string out = "# %ECSV 1.0\n# ---\n# datatype:\n";
  for (const Column &c : table.columns()) {
    out += fmt::format("# - {{name: {}, ", quoted_yaml(c.name));
    if (is_numeric(c.cells) || !c.unit.empty())
      out += fmt::format("unit: {}, ", quoted_yaml(c.unit));
    out += fmt::format("datatype: {}, description: {}}}\n", type_name(c.cells),
                       quoted_yaml(c.description));
  }
  if (!table.notes().empty()) {
    out += "# meta: !!omap\n";
    for (const auto &[key, value] : table.notes())
      out += fmt::format("# - {{{}: {}}}\n", quoted_yaml(key), quoted_yaml(value));
  }
  out += "# schema: astropy-2.0\n";
  for (std::size_t c = 0; c < table.columns().size(); ++c)
    out += (c ? " " : "") + quoted_cell(table.columns()[c].name, TextForm::Ecsv);
  return out + '\n';
}

std::string to_ecsv(const Table &table) {
  std::string out = ecsv_header(table);
  append_rows(table, 0, table.rows(), TextForm::Ecsv, out);
  return out;
}

std::string csv_note(const std::string &text) { return "# " + one_line(text) + "\n"; }

std::string csv_header(const Table &table) {
  std::string names, units;
  std::string out;
  if (!table.notes().empty())
    out =
        csv_note("read with pandas.read_csv(NAME, comment=\"#\") or astropy: Table.read(NAME, "
                 "format=\"ascii.csv\", comment=\"#\"); units stand in the line above the header");
  for (const auto &[key, value] : table.notes())
    out += csv_note(key + ": " + value);
  for (const Column &c : table.columns()) {
    const char *comma = names.empty() ? "" : ",";
    names += comma + quoted_cell(c.name, TextForm::Csv);
    units += comma + c.unit;
  }
  return out + "# unit: " + units + '\n' + names + '\n';
}

void append_csv_rows(const Table &table, std::size_t begin, std::size_t end, std::string &out) {
  append_rows(table, begin, end, TextForm::Csv, out);
}

std::string to_csv(const Table &table) {
  std::string out = csv_header(table);
  append_csv_rows(table, 0, table.rows(), out);
  return out;
}

std::string to_json(const Table &table) {
  std::string out = "[";
  for (std::size_t row = 0; row < table.rows(); ++row) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (const Column &column : table.columns())
      object[column.name] = json_cell(column, row);
    out += row ? ",\n " : "\n ";
    out += object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
  return out + (table.rows() ? "\n]\n" : "]\n");
}

std::string to_text(const Table &table) {
  const std::size_t count = table.columns().size();
  std::vector<std::vector<std::string>> cells(table.rows() + 2, std::vector<std::string>(count));
  std::vector<std::size_t> width(count);
  for (std::size_t c = 0; c < count; ++c) {
    const Column &column = table.columns()[c];
    cells[0][c] = column.name;
    cells[1][c] = column.unit.empty() ? "" : "[" + column.unit + "]";
    for (std::size_t row = 0; row < table.rows(); ++row)
      cells[row + 2][c] = terminal_cell(table, column, row);
    for (const auto &line : cells)
      width[c] = std::max(width[c], line[c].size());
  }
  std::string out;
  for (const auto &line : cells) {
    std::string text;
    for (std::size_t c = 0; c < count; ++c) {
      const bool right = is_numeric(table.columns()[c].cells);
      text += c ? "  " : "";
      text += right ? fmt::format("{:>{}}", line[c], width[c])
                    : fmt::format("{:<{}}", line[c], width[c]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    out += text + '\n';
  }
  return out;
}

} // namespace umov
