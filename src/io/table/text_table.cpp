#include "io/table/text_table.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>
#include <utility>

namespace umov {
namespace {

/// Cells between blanks; quotes as in RFC 4180. Empty if a quote stays open.
std::optional<std::vector<CsvCell>> blank_cells(std::string_view line) {
  std::vector<CsvCell> out;
  std::size_t i = 0;
  while (i < line.size()) {
    if (line[i] == ' ' || line[i] == '\t') {
      ++i;
      continue;
    }
    std::string cell;
    const std::size_t column = i + 1;
    if (line[i] != '"') {
      const std::size_t end = std::min(line.find_first_of(" \t", i), line.size());
      cell = line.substr(i, end - i);
      i = end;
    } else {
      for (++i;; ++i) {
        if (i >= line.size())
          return std::nullopt;
        if (line[i] == '"' && (i + 1 >= line.size() || line[i + 1] != '"'))
          break;
        i += line[i] == '"' ? 1u : 0u;
        cell += line[i];
      }
      ++i;
    }
    out.push_back({std::move(cell), column});
  }
  return out;
}

/// What stands behind `key` in a flow mapping of YAML, without quotes.
std::string yaml_value(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos)
    return {};
  std::string_view rest = trimmed(text.substr(at + key.size()));
  if (rest.starts_with('"') || rest.starts_with('\''))
    return std::string(rest.substr(1, rest.find(rest.front(), 1) - 1));
  return std::string(trimmed(rest.substr(0, rest.find_first_of(",}"))));
}

/// `key: value` or `key: 'value'` of YAML as astropy writes it; nothing where there are more keys.
std::optional<std::pair<std::string, std::string>> yaml_pair(std::string_view text) {
  const std::size_t colon = text.find(": ");
  if (colon == std::string_view::npos)
    return std::nullopt;
  std::string_view rest = trimmed(text.substr(colon + 2));
  std::string value;
  if (!rest.starts_with('\'')) {
    if (rest.find(", ") != std::string_view::npos)
      return std::nullopt;
    value = rest;
  } else {
    for (rest.remove_prefix(1); !rest.empty(); rest.remove_prefix(1)) {
      if (rest.front() == '\'' && rest.size() == 1)
        break;
      if (rest.front() == '\'' && rest[1] != '\'')
        return std::nullopt;
      rest.remove_prefix(rest.front() == '\'' ? 1 : 0);
      value += rest.front();
    }
  }
  return std::pair(std::string(trimmed(text.substr(0, colon))), value);
}

/// A line "key: value" of people, who leave the space out or write "key = value": where the key
/// ends; npos for other words.
std::size_t end_of_key(std::string_view text) {
  if (const std::size_t colon = text.find(": "); colon != std::string_view::npos)
    return colon;
  const std::size_t mark = text.find_first_of(":=");
  const std::string_view key = trimmed(text.substr(0, std::min(mark, text.size())));
  const auto belongs = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  const bool is_key = !key.empty() && std::ranges::all_of(key, belongs);
  return is_key ? mark : std::string_view::npos;
}

} // namespace

namespace {

/// What stands in rows, and hardly is a name: a number, or what begins with a date (ISO 8601).
bool is_value(std::string_view cell) {
  constexpr std::string_view date = "0000-00-00";
  const auto fits = [](char form, char c) {
    return form == '0' ? c >= '0' && c <= '9' : c == form;
  };
  return parse_number(cell) ||
         (cell.size() >= date.size() && std::equal(date.begin(), date.end(), cell.begin(), fits));
}

} // namespace

std::optional<std::string> why_no_names(std::string_view line) {
  bool is_quoted = false;
  std::ptrdiff_t more = 0; // semicolons than commas
  for (const char c : line) {
    is_quoted = is_quoted != (c == '"');
    if (!is_quoted)
      more += c == ';' ? 1 : c == ',' ? -1 : 0;
  }
  if (more <= 0)
    return std::nullopt;
  return "the names of the columns are parted by semicolons; commas were expected. Save it so, "
         "with points in its numbers";
}

std::optional<std::string> why_no_names(const std::vector<std::string> &columns) {
  const auto values = std::ranges::count_if(columns, is_value);
  // Names may hold numbers, such as wavelengths: rows begin with one, or hold no other word.
  const bool is_row = !columns.empty() &&
                      (is_value(columns.front()) ? 2 * values >= std::ssize(columns)
                                                 : values > 0 && values + 1 == std::ssize(columns));
  if (!is_row)
    return std::nullopt;
  return "numbers where the names of the columns were expected; write a line of names above them";
}

tl::unexpected<Error> without_column(const TextTable &table, const std::string &file,
                                     const std::string &message) {
  const auto why = why_no_names(table.columns);
  return fail(ErrorCode::BadInput, why ? *why + ": " + message : message,
              {file, table.header_line});
}

std::optional<std::size_t> column_named(const TextTable &table, std::string_view name) {
  const auto at = std::ranges::find(table.columns, name);
  if (at == table.columns.end())
    return std::nullopt;
  return static_cast<std::size_t>(at - table.columns.begin());
}

Result<double> number_in(const TextTable &table, std::size_t row, std::size_t column, double low,
                         double high, std::string_view what, const std::string &file,
                         std::string_view advice) {
  const std::string_view cell = table.cell(row, column);
  const auto value = parse_number(cell);
  if (!value || !(*value >= low && *value <= high))
    return fail(ErrorCode::BadInput,
                fmt::format("{} = \"{}\"; {} was expected{}", table.columns[column],
                            printable(cell), what, advice),
                {file, table.lines[row]});
  return *value;
}

void put_note(std::string_view words, std::map<std::string, std::string> &notes) {
  if (const std::size_t end = end_of_key(words); end != std::string_view::npos)
    notes[std::string(trimmed(words.substr(0, end)))] = trimmed(words.substr(end + 1));
}

namespace {

/// A line of the header: `# - {name: ..., unit: ...}` or `# - {"key": "value"}` of ECSV, the same
/// with YAML's quotes, or `# key: value`.
void read_note(std::string_view line, TextTable &table) {
  std::string_view text = trimmed(line.substr(1));
  auto &notes = table.notes;
  if (text.starts_with("- {name: ")) {
    table.units[yaml_value(text, "name: ")] = yaml_value(text, ", unit: ");
    return;
  }
  if (text.starts_with("- {\"")) {
    const auto json = nlohmann::json::parse(text.substr(2), nullptr, false);
    if (json.is_object() && json.size() == 1 && json.begin()->is_string())
      notes[json.begin().key()] = json.begin()->get<std::string>();
    return;
  }
  if (text.starts_with("- {") && text.ends_with('}')) {
    if (auto pair = yaml_pair(text.substr(3, text.size() - 4)))
      notes.insert_or_assign(std::move(pair->first), std::move(pair->second));
    return;
  }
  put_note(text, notes);
}

Result<void> add_header(TextTable &out, const std::vector<CsvCell> &cells, const Where &where) {
  for (const CsvCell &cell : cells)
    out.columns.push_back(cell.text);
  out.header_line = where.line;
  // Numbers that stand twice are no names: what looks for its columns says so.
  std::vector<std::string> names;
  std::ranges::remove_copy_if(out.columns, std::back_inserter(names), is_value);
  std::ranges::sort(names);
  if (const auto twice = std::ranges::adjacent_find(names); twice != names.end()) {
    const auto why = why_no_names(out.columns);
    return fail(
        ErrorCode::BadInput,
        why.value_or(fmt::format("column \"{}\" stands twice; leave one out", printable(*twice))),
        where);
  }
  // The line that CSV files of ours have above the names.
  if (const auto told = out.notes.find("unit"); told != out.notes.end())
    if (const auto units = csv_cells(told->second); units && units->size() == out.columns.size())
      for (std::size_t c = 0; c < out.columns.size(); ++c)
        out.units[out.columns[c]] = (*units)[c].text;
  return {};
}

} // namespace

std::string_view TextTable::cell(std::size_t row, std::size_t column) const {
  const std::size_t at = row * columns.size() + column;
  const std::uint32_t begin = column == 0 ? 0 : ends_[at - 1];
  return std::string_view(text_).substr(begins_[row] + begin, ends_[at] - begin);
}

void TextTable::add_cell(std::string_view text) {
  text_ += text;
  ends_.push_back(static_cast<std::uint32_t>(text_.size() - begin_));
}

void TextTable::end_row(std::size_t line) {
  begins_.push_back(std::exchange(begin_, text_.size()));
  lines.push_back(line);
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

std::optional<bool> truth_of(std::string cell) {
  cell = lower_case(std::move(cell));
  if (cell == "true" || cell == "1")
    return true;
  if (cell.empty() || cell == "false" || cell == "0")
    return false;
  return std::nullopt;
}

Result<void> check_polcconv(const TextTable &table, const std::string &file) {
  const auto told = table.notes.find("POLCCONV");
  if (told == table.notes.end() || told->second == "IAU")
    return {};
  return fail(ErrorCode::BadInput,
              fmt::format("POLCCONV of the header is \"{}\": IAU was expected (angles from north "
                          "through east). Turn the sign of u, and write IAU",
                          printable(told->second)),
              {file});
}

Result<TextTable> read_text_table(std::string_view text, const std::string &file) {
  constexpr std::size_t rows_max = 20'000'000, line_max = 100'000;
  if (const auto why = why_no_text(text))
    return fail(ErrorCode::BadInput, *why, {file});
  if (text.starts_with("\xEF\xBB\xBF")) // a mark that spreadsheets put before UTF-8
    text.remove_prefix(3);
  TextTable out;
  bool has_blanks = false;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line =
        trimmed(text.substr(0, text.substr(0, end).ends_with('\r') ? end - 1 : end));
    text.remove_prefix(std::min(end + 1, text.size()));
    const Where where{file, ++number};
    if (line.empty())
      continue;
    if (line.front() == '#') {
      read_note(line, out);
      continue;
    }
    if (line.size() > line_max || out.rows() >= rows_max)
      return fail(ErrorCode::BadInput,
                  fmt::format("more than {} bytes in a line, or more than {} rows; is it a table? "
                              "Split it",
                              line_max, rows_max),
                  where);
    if (out.columns.empty()) {
      if (const auto why = why_no_names(line))
        return fail(ErrorCode::BadInput, *why, where);
      has_blanks = line.find(',') == std::string_view::npos;
    }
    if ((out.rows() + 1) * out.columns.size() > table_cells_max)
      return fail(
          ErrorCode::BadInput,
          fmt::format("more than {} cells, which would fill the memory; split the table, or "
                      "leave out columns",
                      table_cells_max),
          where);
    const auto cells = has_blanks ? blank_cells(line) : csv_cells(line);
    if (!cells)
      return fail(ErrorCode::BadInput, "a quote is not closed in this row; close it with \"",
                  where);
    if (out.columns.empty()) {
      UMOV_TRY(add_header(out, *cells, where));
      continue;
    }
    if (cells->size() != out.columns.size())
      return fail(ErrorCode::BadInput,
                  fmt::format("{} cells in a table of {} columns; one for each name was expected",
                              cells->size(), out.columns.size()),
                  where);
    for (const CsvCell &cell : *cells)
      out.add_cell(cell.text);
    out.end_row(number);
  }
  return out;
}

std::size_t column_of_cell(std::string_view text, std::size_t line, std::size_t cell) {
  bool has_blanks = false, has_header = false;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view here = text.substr(0, end);
    const std::string_view words = trimmed(here);
    if (!has_header && !words.empty() && words.front() != '#') {
      has_header = true;
      has_blanks = here.find(',') == std::string_view::npos;
    }
    if (number == line) {
      const auto cells = has_blanks ? blank_cells(here) : csv_cells(here);
      return cells && cell < cells->size() ? (*cells)[cell].column : 0;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return 0;
}

} // namespace umov
