// TLE lines before their fields: kind, characters, layout, length, checksum.

#include "io/elements/tle_line.h"

#include <array>
#include <span>
#include <umov/core/text.h>

namespace umov::tle {

namespace {

constexpr std::size_t full_length = 69;

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }

/// A character outside ASCII that pasted element sets are known to hold.
struct Lookalike {
  std::string_view bytes;
  char ascii;
  std::string_view name;
};
constexpr std::array<Lookalike, 8> lookalikes{{{"\xC2\xA0", ' ', "a non-breaking space (U+00A0)"},
                                               {"\xE2\x80\x87", ' ', "a figure space (U+2007)"},
                                               {"\xE2\x80\x89", ' ', "a thin space (U+2009)"},
                                               {"\xE2\x80\xAF", ' ', "a narrow space (U+202F)"},
                                               {"\xE2\x88\x92", '-', "a Unicode minus (U+2212)"},
                                               {"\xE2\x80\x93", '-', "an en dash (U+2013)"},
                                               {"\xE2\x80\x90", '-', "a Unicode hyphen (U+2010)"},
                                               {"\xE2\x80\x91", '-', "a Unicode hyphen (U+2011)"}}};

const Lookalike *lookalike_at(std::string_view text) {
  for (const Lookalike &l : lookalikes)
    if (text.starts_with(l.bytes))
      return &l;
  return nullptr;
}

/// The start of a line with lookalikes replaced; enough of it to judge the kind.
std::string folded_start(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size() && out.size() < full_length + 1;) {
    const Lookalike *l = lookalike_at(text.substr(i));
    out += l ? l->ascii : text[i];
    i += l ? l->bytes.size() : 1;
  }
  return out;
}

bool has_catalogue_number(std::string_view line) {
  if (line.size() < 7 || !is_digit(line[6]))
    return false;
  for (std::size_t i = 3; i < 6; ++i)
    if (!is_digit(line[i]) && line[i] != ' ')
      return false;
  return is_digit(line[2]) || is_upper(line[2]) || line[2] == ' ';
}

struct Literal {
  std::size_t column;
  char character;
};
constexpr Literal first_layout[] = {{2, ' '},  {9, ' '},  {18, ' '}, {24, '.'}, {33, ' '},
                                    {35, '.'}, {44, ' '}, {53, ' '}, {62, ' '}, {64, ' '}};
constexpr Literal second_layout[] = {{2, ' '},  {8, ' '},  {12, '.'}, {17, ' '},
                                     {21, '.'}, {26, ' '}, {34, ' '}, {38, '.'},
                                     {43, ' '}, {47, '.'}, {52, ' '}, {55, '.'}};

std::string quoted(char c) { return c == ' ' ? "a blank" : std::string("'") + c + "'"; }

Result<void> check_characters(const Line &line, const std::string &file) {
  for (std::size_t i = 0; i < line.text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(line.text[i]);
    const Where where{file, line.number, i + 1}; // all characters before it are single bytes
    if (byte == '\t')
      return fail(ErrorCode::BadInput,
                  "found a tab; element lines stand in fixed columns and hold blanks. Replace "
                  "tabs by the right number of blanks or fetch the set again.",
                  where);
    if (byte >= 0x20 && byte < 0x7F)
      continue;
    const Lookalike *l = lookalike_at(line.text.substr(i));
    if (!l)
      return fail(ErrorCode::BadInput,
                  "found a character that is not plain ASCII; element lines hold digits, capital "
                  "letters, blanks, '+', '-' and '.'. Fetch the set again.",
                  where);
    return fail(ErrorCode::BadInput,
                "found " + std::string(l->name) + ", expected " +
                    (l->ascii == ' ' ? "a plain blank" : "a plain '-'") +
                    "; the set was probably copied from a web page. Replace it or fetch the set "
                    "as plain text.",
                where);
  }
  return {};
}

Result<void> check_layout(const Line &line, Kind kind, const std::string &file) {
  const std::span<const Literal> layout =
      kind == Kind::First ? std::span<const Literal>(first_layout) : second_layout;
  for (const Literal &l : layout) {
    if (l.column > line.text.size())
      break; // the length is judged next
    const char found = line.text[l.column - 1];
    if (found != l.character)
      return fail(ErrorCode::BadInput,
                  "column " + std::to_string(l.column) + " should be " + quoted(l.character) +
                      ", found " + quoted(found) +
                      "; the columns are shifted: a blank was probably lost or added. Fetch the "
                      "set again as plain text.",
                  {file, line.number, l.column});
  }
  return {};
}

Result<void> check_length(const Line &line, const std::string &file) {
  const std::size_t length = line.text.size();
  if (length == full_length || length == full_length - 1)
    return {};
  const bool is_long = length > full_length;
  return fail(ErrorCode::BadInput,
              "the line has " + std::to_string(length) + " columns, expected 69; " +
                  (is_long ? "remove what stands after column 69."
                           : "it may be truncated. Fetch the set again."),
              {file, line.number, is_long ? full_length + 1 : length + 1});
}

Result<void> check_sum(const Line &line, const std::string &file, bool is_allowed,
                       LineNotes &notes) {
  const char found = line.text[full_length - 1];
  const Where where{file, line.number, full_length};
  if (!is_digit(found))
    return fail(ErrorCode::BadInput,
                "the checksum in column 69 should be a digit, found " + quoted(found) +
                    ". Fetch the set again.",
                where);
  int sum = 0;
  for (const char c : line.text.substr(0, full_length - 1))
    sum += is_digit(c) ? c - '0' : c == '-' ? 1 : 0;
  if (sum % 10 == found - '0')
    return {};
  const std::string message = std::string("checksum is ") + found + ", computed " +
                              std::to_string(sum % 10) + "; a character was probably changed.";
  if (!is_allowed)
    return fail(ErrorCode::BadInput,
                message + " Fetch the set again or pass --allow-bad-checksum (in Python "
                          "allow_bad_checksum=True).",
                where);
  notes.bad_checksum = message;
  return {};
}

} // namespace

Kind kind_of(std::string_view text) {
  const std::string_view bare = trimmed(text);
  if (bare.empty())
    return Kind::Blank;
  if (bare.front() == '#')
    return Kind::Comment;
  const std::string start = folded_start(text);
  const bool is_long = start.size() >= 50; // far longer than a name, even with lost blanks
  if (start.size() > 2 && is_digit(start[0]) && (start[1] == ' ' || is_long)) {
    const bool has_number = has_catalogue_number(start);
    if ((start[0] == '1' || start[0] == '2') && (has_number || is_long))
      return start[0] == '1' ? Kind::First : Kind::Second;
    if (has_number && start.size() >= full_length - 1)
      return Kind::OtherNumber;
  }
  // Moved to the right by leading blanks: still an element line, refused by its layout.
  const std::string_view moved = trimmed(start);
  if (moved.size() < start.size() && moved.size() >= 50 && moved[1] == ' ' &&
      (moved[0] == '1' || moved[0] == '2'))
    return moved[0] == '1' ? Kind::First : Kind::Second;
  return Kind::Name;
}

Result<LineNotes> check_line(const Line &line, Kind kind, const std::string &file,
                             const TleOptions &options) {
  LineNotes notes;
  UMOV_TRY(check_characters(line, file));
  if (line.text.front() == ' ')
    return fail(ErrorCode::BadInput,
                "the line begins with a blank, expected its number in column 1. Remove the "
                "leading blanks.",
                {file, line.number, 1});
  UMOV_TRY(check_layout(line, kind, file));
  UMOV_TRY(check_length(line, file));
  notes.lacks_checksum = line.text.size() < full_length;
  if (!notes.lacks_checksum)
    UMOV_TRY(check_sum(line, file, options.allow_bad_checksum, notes));
  return notes;
}

std::string clean_name(std::string_view text, bool &is_changed) {
  text = trimmed(text);
  if (text.starts_with("0 "))
    text = trimmed(text.substr(2));
  return printable(text, &is_changed);
}

} // namespace umov::tle
