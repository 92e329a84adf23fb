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

bool is_numeric(const std::vector<std::string> &words) {
  return (words.size() == 2 || words.size() == 3) &&
         std::ranges::all_of(words,
                             [](const std::string &w) { return parse_number(w).has_value(); });
}

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
  if (!out.empty() && !is_numeric(out.front().words)) {
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
  return !rows.empty() && is_numeric(rows.front().words);
}

Result<IndexTable> read_index_columns(std::string_view text, const std::string &file) {
  std::string header;
  const auto rows = rows_of(text, header, 1'000'000);
  std::vector<double> nm, n, k;
  for (const Row &row : rows) {
    if (!is_numeric(row.words) || row.words.size() != rows.front().words.size())
      return fail(ErrorCode::BadInput,
                  fmt::format("\"{}\"; {} numbers were expected: wavelength, n{}",
                              printable(row.words[0].substr(0, 40)), rows.front().words.size(),
                              rows.front().words.size() == 3 ? " and k" : ""),
                  {file, row.line});
    nm.push_back(*parse_number(row.words[0]));
    if (nm.size() > 1 && !(nm.back() > nm[nm.size() - 2]))
      return fail(
          ErrorCode::BadInput,
          fmt::format("wavelength {:g} follows {:g}; increasing ones were expected. Sort them "
                      "and leave repeated ones out.",
                      nm.back(), nm[nm.size() - 2]),
          {file, row.line});
    n.push_back(*parse_number(row.words[1]));
    if (row.words.size() == 3)
      k.push_back(*parse_number(row.words[2]));
  }
  // Optical tables begin above 10 nm and end below 100 um: one unit cannot be taken for the other.
  double unit = unit_in(header);
  if (unit == 0 && nm.front() >= 100)
    unit = 1;
  if (unit == 0 && nm.back() <= 100)
    unit = 1000;
  if (unit == 0)
    return fail(
        ErrorCode::BadInput,
        fmt::format("wavelengths {:g} to {:g}: nm or um? Say it in the header line, such as "
                    "wavelength_nm,n,k",
                    nm.front(), nm.back()),
        {file});
  for (double &one : nm)
    one *= unit;
  IndexTable out;
  out.name = std::filesystem::path(file).stem().string();
  out.has_k = !k.empty();
  out.n = Tabulated{nm, n};
  if (out.has_k)
    out.k = {nm, k};
  if (auto checked = check_index(out); !checked)
    return fail(ErrorCode::BadInput, checked.error().message, {file});
  return out;
}

} // namespace umov
