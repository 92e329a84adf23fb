// Tables of two or three columns: wavelength, n and k, as spectrometers, ellipsometers and papers
// give them.

#include "io/index/index_columns.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {
namespace {

struct Row {
  std::vector<std::string> words;
  std::size_t line = 0;
};

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> out;
  std::string word;
  for (const char c : line) {
    const bool is_between = c == ',' || c == ';' || std::isspace(static_cast<unsigned char>(c));
    if (!is_between)
      word += c;
    else if (!word.empty())
      out.push_back(std::exchange(word, {}));
  }
  if (!word.empty())
    out.push_back(word);
  return out;
}

/// A row begins with a wavelength; what else stands in it is judged with its line.
bool is_row(const std::vector<std::string> &words) { return parse_number(words[0]).has_value(); }

/// Lines with something in them; comments and the header are collected for the unit that they name.
std::vector<Row> rows_of(std::string_view text, std::string &header, std::size_t most) {
  std::vector<Row> out;
  std::size_t line = 0;
  for (std::size_t begin = 0; begin < text.size() && out.size() < most;) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view one = text.substr(begin, end - begin);
    begin = end + 1;
    ++line;
    const auto words = words_of(one);
    if (words.empty())
      continue;
    const bool is_comment = words[0][0] == '#' || words[0][0] == '%' || words[0][0] == '!';
    if (is_comment)
      header += std::string(one.substr(0, 200)) + "\n";
    else
      out.push_back({words, line});
  }
  if (!out.empty() && !is_row(out.front().words)) {
    for (const std::string &word : out.front().words)
      header += word + " ";
    out.erase(out.begin());
  }
  return out;
}

/// What one unit of the wavelengths is in nm, from the words of the header; 0: they do not say.
double unit_in(const std::string &header) {
  std::string words;
  for (const char c : header)
    words += std::isalpha(static_cast<unsigned char>(c)) || (c & 0x80) != 0
                 ? static_cast<char>(std::tolower(static_cast<unsigned char>(c)))
                 : ' ';
  words = " " + words + " ";
  const auto has = [&](const char *word) {
    return words.find(fmt::format(" {} ", word)) != std::string::npos;
  };
  if (has("nm") || has("nanometer") || has("nanometre") || has("nanometers"))
    return 1;
  if (has("um") || has("\xc2\xb5m") || has("\xce\xbcm") || has("micron") || has("microns") ||
      has("micrometer") || has("micrometre"))
    return 1000;
  return has("angstrom") || has("angstroms") ? 0.1 : 0;
}

} // namespace

bool is_index_columns(std::string_view text) {
  std::string header;
  const auto rows = rows_of(text.substr(0, 65536), header, 3);
  if (!rows.empty() && is_row(rows.front().words)) {
    const auto &words = rows.front().words;
    const auto numbers = std::ranges::count_if(
        words, [](const std::string &w) { return parse_number(w).has_value(); });
    return (words.size() == 2 || words.size() == 3) &&
           static_cast<std::size_t>(numbers) + 1 >= words.size(); // one may be wrong, and is named
  }
  const std::string first = lowered(header.substr(0, header.find(' ')));
  return first.starts_with("wavelength") || first.starts_with("lambda");
}

namespace {

/// A row of as many numbers as the first, in the order of wavelengths.
Result<void> check_row(const Row &row, std::size_t columns, double before,
                       const std::string &file) {
  const Where where{file, row.line};
  if (row.words.size() != columns)
    return fail(ErrorCode::BadInput,
                fmt::format("{} numbers in this row, {} in the first; wavelength, n and perhaps k "
                            "were expected in each",
                            row.words.size(), columns),
                where);
  for (const std::string &word : row.words)
    if (!parse_number(word))
      return fail(
          ErrorCode::BadInput,
          fmt::format("\"{}\" is no finite number; wavelength, n{} were expected. Correct the "
                      "row, or leave it out",
                      printable(word.substr(0, 40)), columns == 3 ? " and k" : ""),
          where);
  const double wavelength = *parse_number(row.words[0]), n = *parse_number(row.words[1]);
  const double k = columns == 3 ? *parse_number(row.words[2]) : 0;
  if (!(wavelength > before))
    return fail(ErrorCode::BadInput,
                before > 0 ? fmt::format("wavelength {:g} follows {:g}; increasing ones were "
                                         "expected. Sort them and leave repeated ones out.",
                                         wavelength, before)
                           : fmt::format("wavelength {:g}; one above 0 was expected", wavelength),
                where);
  if (!(n > 0) || !(k >= 0))
    return fail(
        ErrorCode::BadInput,
        n > 0
            ? fmt::format("k = {:g}; 0 or more was expected (n + ik, k > 0 absorbs). Turn the "
                          "sign of k where a table is of n - ik",
                          k)
            : fmt::format("n = {:g}; a positive number was expected. Correct the row, or leave it "
                          "out",
                          n),
        where);
  return {};
}

/// The first row with an n or k that is none of any substance; of other faults the first.
const Row &odd_row(const std::vector<Row> &rows) {
  const auto is_odd = [](const Row &row) {
    const double k = row.words.size() == 3 ? *parse_number(row.words[2]) : 0;
    return !check_index(constant_index({*parse_number(row.words[1]), k}));
  };
  const auto at = std::ranges::find_if(rows, is_odd);
  return at == rows.end() ? rows.front() : *at;
}

/// A table in nm whose header says um is 1000 times off, and is read without a word.
Result<double> unit_of(const std::string &header, double first, double last, const Where &where) {
  double unit = unit_in(header);
  if (unit == 1000 && first >= 100)
    return fail(ErrorCode::BadInput,
                fmt::format("the first wavelength is {:g}, and the header says um; is the table in "
                            "nm? Write nm there, or divide by 1000.",
                            first),
                where);
  // Optical tables begin above 10 nm and end below 100 um: one unit cannot be taken for the other.
  if (unit == 0 && first >= 100)
    unit = 1;
  if (unit == 0 && last <= 100)
    unit = 1000;
  if (unit != 0)
    return unit;
  return fail(ErrorCode::BadInput,
              fmt::format("wavelengths {:g} to {:g}: nm or um? Say it in the header line, such as "
                          "wavelength_nm,n,k",
                          first, last),
              where);
}

} // namespace

Result<IndexTable> read_index_columns(std::string_view text, const std::string &file) {
  std::string header;
  const auto rows = rows_of(text, header, 1'000'000);
  if (rows.size() < 2)
    return fail(
        ErrorCode::BadInput,
        fmt::format("{} of wavelength, n and k; two or more were expected. A value that "
                    "holds everywhere is written index = {{ n = 1.5, k = 0 }} in a material",
                    counted(rows.size(), "row")),
        {file});
  std::vector<double> nm, n, k;
  nm.reserve(rows.size());
  n.reserve(rows.size());
  const std::size_t columns = rows.front().words.size();
  if (columns != 2 && columns != 3)
    return fail(
        ErrorCode::BadInput,
        fmt::format("{} words in this row; wavelength, n and perhaps k were expected", columns),
        {file, rows.front().line});
  for (const Row &row : rows) {
    UMOV_TRY(check_row(row, columns, nm.empty() ? 0 : nm.back(), file));
    nm.push_back(*parse_number(row.words[0]));
    n.push_back(*parse_number(row.words[1]));
    if (columns == 3)
      k.push_back(*parse_number(row.words[2]));
  }
  const Where begin{file, rows.front().line};
  UMOV_ASSIGN(unit, unit_of(header, nm.front(), nm.back(), begin));
  for (double &one : nm)
    one *= unit;
  IndexTable out;
  out.name = std::filesystem::path(file).stem().string();
  out.has_k = !k.empty();
  out.n = Tabulated{nm, n};
  if (out.has_k)
    out.k = {nm, k};
  if (auto checked = check_index(out); !checked)
    return fail(ErrorCode::BadInput, checked.error().message, {file, odd_row(rows).line});
  return out;
}

} // namespace umov
