// Two columns of wavelength and response, as makers of filters and photometric packages give them.

#include "io/passband/curve_text.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov::passband {
namespace {

/// Pieces of a line between blanks, commas and semicolons.
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> out(1);
  for (const char c : line)
    if (c == ',' || c == ';' || std::isspace(static_cast<unsigned char>(c)) != 0)
      out.emplace_back();
    else
      out.back() += c;
  std::erase(out, "");
  return out;
}

/// The words of a line: letters, and what is not ASCII.
std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> out(1);
  for (const char c : line)
    if (std::isalpha(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0)
      out.back() += c;
    else
      out.emplace_back();
  std::erase(out, "");
  return out;
}

/// The word after the first `key` of a line, if any.
std::string word_after(const std::vector<std::string> &words, std::string_view key) {
  for (std::size_t i = 0; i + 1 < words.size(); ++i)
    if (lowered(words[i]) == key)
      return words[i + 1];
  return {};
}

/// A line that speaks of units: it names them or the wavelengths, has one in brackets, or nothing
/// else. In other words of a comment ("3.45 micron pixels") a unit is of something else.
bool speaks_of_units(std::string_view line, const std::vector<std::string> &words) {
  if (words.size() == 1)
    return true;
  for (const std::string &word : words)
    for (const char *known : {"unit", "units", "wavelength", "wavelengths", "lambda", "wave"})
      if (lowered(word) == known)
        return true;
  for (std::size_t k = 0; k < line.size(); ++k)
    if (line[k] == '(' || line[k] == '[')
      if (const auto end = line.find_first_of(")]", k); end != std::string_view::npos)
        if (unit_nm(trimmed(line.substr(k + 1, end - k - 1))) > 0)
          return true;
  return false;
}

/// Takes what a line of the header says. The unit that stands beside the word wavelength holds
/// (ECSV: "name: wavelength, unit: Angstrom"), else the first that a line about units names.
void take_header(std::string_view line, PassbandForm &form, bool &is_sure) {
  const auto words = words_of(line);
  const std::string kind = lowered(word_after(words, "detector"));
  if (kind.starts_with("photon"))
    form.detector = DetectorKind::Photon;
  else if (kind == "energy")
    form.detector = DetectorKind::Energy;
  if (is_sure || !speaks_of_units(line, words))
    return;
  const bool is_named = std::ranges::any_of(
      words, [](const std::string &word) { return lowered(word) == "wavelength"; });
  const std::string after_unit = word_after(words, "unit");
  for (const std::string &word : words)
    if (unit_nm(word) > 0 && (after_unit.empty() || word == after_unit)) {
      if (form.unit.empty() || is_named || !after_unit.empty())
        form.unit = word;
      is_sure = is_named || !after_unit.empty();
      return;
    }
}

} // namespace

double unit_nm(std::string_view name) {
  const std::string unit = lowered(name);
  for (const char *known : {"nm", "nanometer", "nanometers", "nanometre", "nanometres"})
    if (unit == known)
      return 1;
  for (const char *known : {"um", "\xc2\xb5m", "\xce\xbcm", "micron", "microns", "micrometer",
                            "micrometers", "micrometre", "micrometres"})
    if (unit == known)
      return 1000;
  for (const char *known : {"angstrom", "angstroms", "aa", "\xc3\xa5", "\xc3\x85", "\xe2\x84\xab"})
    if (unit == known)
      return 0.1;
  return 0;
}

Result<Curve> read_columns(const std::string &text, const std::string &file) {
  Curve out;
  bool is_sure = false;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    ++number;
    const auto cells = cells_of(line);
    if (cells.empty())
      continue;
    if (cells[0][0] == '#' || cells[0][0] == '%' || cells[0][0] == '!') {
      take_header(line.substr(0, 300), out.form, is_sure);
      continue;
    }
    const auto first = parse_number(cells[0]);
    if (!first && out.wavelength.empty()) { // names of the columns
      take_header(line.substr(0, 300), out.form, is_sure);
      continue;
    }
    const auto second = cells.size() == 2 ? parse_number(cells[1]) : std::nullopt;
    if (!first || !second)
      return fail(ErrorCode::BadInput,
                  fmt::format("\"{}\"; two numbers were expected: wavelength and response",
                              printable(trimmed(line.substr(0, 60)))),
                  {file, number});
    out.wavelength.push_back(*first);
    out.response.push_back(*second);
    out.line.push_back(number);
  }
  if (out.wavelength.empty())
    return fail(ErrorCode::BadInput,
                "no row with two numbers; wavelength and response of a band were expected, or a "
                "VOTable of the SVO Filter Profile Service",
                {file});
  return out;
}

} // namespace umov::passband
