#include <umov/io/index_file.h>

#include "io/index/index_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <yaml-cpp/yaml.h>

namespace umov {
namespace {

/// What is read, with the place for messages.
struct Reader {
  const std::string &file;

  [[nodiscard]] Where at(const YAML::Node &node, std::size_t more_lines = 0) const {
    const YAML::Mark mark = node.Mark();
    return mark.is_null() ? Where{file}
                          : Where{file, static_cast<std::size_t>(mark.line) + 1 + more_lines};
  }
  [[nodiscard]] tl::unexpected<Error> problem(const YAML::Node &node, const std::string &text,
                                              std::size_t more_lines = 0) const {
    return fail(ErrorCode::BadInput, text, at(node, more_lines));
  }
};

/// The next word, which leaves the text; empty at its end. Not by a stream, which takes a lack of
/// memory for the end.
std::string_view next_word(std::string_view &text) {
  constexpr std::string_view blanks = " \t\n\v\f\r";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view out = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(out.size());
  return out;
}

Result<std::string> text_of(const Reader &reader, const YAML::Node &entry, const char *key) {
  const YAML::Node node = entry[key];
  if (!node || !node.IsScalar())
    return reader.problem(entry, fmt::format("an entry of DATA has no \"{}\"", key));
  return node.as<std::string>();
}

Result<std::vector<double>> numbers_of(const Reader &reader, const YAML::Node &entry,
                                       const char *key) {
  UMOV_ASSIGN(text, text_of(reader, entry, key));
  std::vector<double> out;
  std::string_view rest = text;
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    const auto value = parse_number(word);
    if (!value)
      return reader.problem(entry[key],
                            fmt::format("{}: \"{}\" is not a finite number", key, word));
    out.push_back(*value);
  }
  return out;
}

/// Rows of `columns` numbers; a block scalar begins on the line after its key.
Result<std::vector<std::vector<double>>> rows_of(const Reader &reader, const YAML::Node &entry,
                                                 std::size_t columns) {
  UMOV_ASSIGN(text, text_of(reader, entry, "data"));
  std::vector<std::vector<double>> out(columns);
  std::string_view rest = text;
  std::size_t line_number = 0;
  while (!rest.empty()) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    ++line_number;
    std::vector<double> row;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      const auto value = parse_number(word);
      if (!value)
        return reader.problem(entry["data"],
                              fmt::format("\"{}\" is not a finite number", word.substr(0, 40)),
                              line_number);
      row.push_back(*value);
    }
    if (row.empty())
      continue;
    if (row.size() != columns)
      return reader.problem(
          entry["data"],
          fmt::format("{} numbers in this row; {} were expected", row.size(), columns),
          line_number);
    if (!out[0].empty() && !(row[0] > out[0].back()))
      return reader.problem(entry["data"],
                            fmt::format("wavelength {:g} um follows {:g}; increasing ones were "
                                        "expected. Sort them and leave repeated ones out.",
                                        row[0], out[0].back()),
                            line_number);
    if (!(row[0] > 0) || row[0] > 10'000)
      return reader.problem(entry["data"],
                            fmt::format("wavelength {:g}; micrometres were expected. Is the table "
                                        "in nm? Divide by 1000.",
                                        row[0]),
                            line_number);
    for (std::size_t c = 0; c < columns; ++c)
      out[c].push_back(row[c]);
  }
  if (out[0].empty())
    return reader.problem(entry, "an entry of DATA has no row");
  if (out[0].size() == 1)
    return reader.problem(entry["data"],
                          "one row of n and k; two or more were expected. A value that holds "
                          "everywhere is written index = { n = 1.5, k = 0 } in a material",
                          1);
  if (out[0].front() >= 100) // no table of optical constants begins at 0.1 mm
    return reader.problem(entry["data"],
                          fmt::format("the first wavelength is {:g}; micrometres were expected. Is "
                                      "the table in nm? Divide by 1000.",
                                      out[0].front()),
                          1);
  for (double &um : out[0])
    um *= 1000;
  return out;
}

Result<DispersionFormula> formula_of(const Reader &reader, const YAML::Node &entry,
                                     const std::string &type) {
  const auto number = parse_number(type.substr(8));
  if (!number || !(*number >= 1 && *number <= 9) || *number != std::floor(*number))
    return reader.problem(entry, "\"" + type + "\" is unknown; formula 1 to 9 was expected");
  DispersionFormula out;
  out.number = static_cast<int>(*number);
  UMOV_ASSIGN(coefficients, numbers_of(reader, entry, "coefficients"));
  out.coefficients = coefficients;
  UMOV_ASSIGN(range, numbers_of(reader, entry, "wavelength_range"));
  if (range.size() != 2)
    return reader.problem(entry["wavelength_range"], "wavelength_range needs two numbers [um]");
  if (!(range[0] > 0 && range[0] < range[1]))
    return reader.problem(entry["wavelength_range"],
                          fmt::format("wavelength_range is {:g} to {:g} um; an increasing range "
                                      "above 0 was expected",
                                      range[0], range[1]));
  out.first_nm = range[0] * 1000;
  out.last_nm = range[1] * 1000;
  return out;
}

Result<void> read_entry(const Reader &reader, const YAML::Node &entry, IndexTable &out,
                        bool &has_n) {
  UMOV_ASSIGN(type, text_of(reader, entry, "type"));
  if (type.starts_with("formula ")) {
    UMOV_ASSIGN(formula, formula_of(reader, entry, type));
    out.n = formula;
    has_n = true;
    return {};
  }
  const bool is_n = type == "tabulated n", is_k = type == "tabulated k";
  if (!is_n && !is_k && type != "tabulated nk")
    return reader.problem(entry, "type \"" + type +
                                     "\" is unknown; tabulated nk, tabulated n, tabulated k or "
                                     "formula 1 to 9 was expected");
  UMOV_ASSIGN(rows, rows_of(reader, entry, is_n || is_k ? 2 : 3));
  if (!is_k) {
    out.n = Tabulated{rows[0], rows[1]};
    has_n = true;
  }
  if (!is_n) {
    out.k = {rows[0], rows.back()};
    out.has_k = true;
  }
  return {};
}

/// The references without their HTML marks, on one line.
std::string plain(const std::string &html) {
  std::string out;
  bool in_mark = false;
  for (const char c : html) {
    if (c == '<' || c == '>')
      in_mark = c == '<';
    else if (!in_mark && (c != '\n' || !out.empty()))
      out += c == '\n' ? ' ' : c;
  }
  while (!out.empty() && out.back() == ' ')
    out.pop_back();
  return out;
}

} // namespace

Result<IndexTable> read_index_text(const std::string &text, const std::string &file) {
  if (const auto why = why_no_text(text))
    return fail(ErrorCode::BadInput, *why, {file});
  if (is_index_columns(text))
    return read_index_columns(text, file);
  const Reader reader{file};
  IndexTable out;
  out.name = std::filesystem::path(file).stem().string();
  out.has_k = false;
  try {
    const YAML::Node root = YAML::Load(text);
    const YAML::Node data = root.IsMap() ? root["DATA"] : YAML::Node();
    if (!data || !data.IsSequence() || data.size() == 0)
      return fail(ErrorCode::BadInput,
                  "no list DATA; a page of refractiveindex.info was expected, or "
                  "columns wavelength, n, k (nm or um in the header)",
                  {file});
    // A page has a few entries; an alias (*name) costs a hostile one nothing and us a table each.
    constexpr std::size_t entries_max = 16;
    if (data.size() > entries_max)
      return reader.problem(
          data, fmt::format("DATA has {} entries; at most {} are read", data.size(), entries_max));
    bool has_n = false;
    for (const YAML::Node &entry : data) {
      if (!entry.IsMap())
        return reader.problem(entry, "an entry of DATA is not a map with \"type\"");
      UMOV_TRY(read_entry(reader, entry, out, has_n));
    }
    if (!has_n)
      return fail(ErrorCode::BadInput, "DATA has no n; a table or formula of n was expected",
                  {file});
    if (const YAML::Node references = root["REFERENCES"]; references && references.IsScalar())
      out.reference = plain(references.as<std::string>());
  } catch (const YAML::Exception &problem) {
    return fail(ErrorCode::BadInput, "is not YAML: " + problem.msg,
                {file, static_cast<std::size_t>(problem.mark.line + 1),
                 static_cast<std::size_t>(problem.mark.column + 1)});
  }
  if (auto checked = check_index(out); !checked)
    return fail(ErrorCode::BadInput, checked.error().message, {file});
  return out;
}

bool is_index_file_name(const std::filesystem::path &name) {
  constexpr std::array suffixes{".yml", ".yaml", ".csv", ".txt", ".dat"};
  return std::ranges::find(suffixes, name.extension().string()) != suffixes.end();
}

Result<IndexTable> read_index_file(const std::filesystem::path &path) {
  UMOV_ASSIGN(text, read_file(path, 16u << 20));
  UMOV_ASSIGN(table, read_index_text(text, path.string()));
  table.file = path.string();
  return table;
}

} // namespace umov
