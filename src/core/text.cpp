#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <new>
#include <set>
#include <umov/core/text.h>
#include <vector>

#include <openssl/crypto.h>
#include <openssl/evp.h>

namespace umov {

std::optional<double> parse_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && (text.front() == '-' || text.front() == '+'))
      return std::nullopt;
  }
  // from_chars also takes "nan" and "inf": only digits and a point may start a number here.
  const std::size_t first = !text.empty() && text.front() == '-' ? 1 : 0;
  if (text.size() <= first || !((text[first] >= '0' && text[first] <= '9') || text[first] == '.'))
    return std::nullopt;
  double value = 0;
  const char *end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, value);
  if (stop != end || !std::isfinite(value))
    return std::nullopt;
  if (status == std::errc::result_out_of_range) { // too small is zero, too large is refused
    const std::size_t exponent = text.find_first_of("eE");
    const bool tiny = exponent != std::string_view::npos && exponent + 1 < text.size() &&
                      text[exponent + 1] == '-';
    return tiny ? std::optional<double>(0.0) : std::nullopt;
  }
  return status == std::errc() ? std::optional<double>(value) : std::nullopt;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        now[j] = std::min(now[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, now);
  }
  return last[b.size()];
}

namespace {

/// Words of a name: "cell_silicon" has two.
std::set<std::string> words_of(std::string_view name) {
  std::set<std::string> out;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find_first_of("_-.", begin), name.size());
    if (end - begin >= 3)
      out.emplace(name.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

/// The shortest known name that begins with a whole given one ("step": "step_s"); empty if none.
std::optional<std::string> longer_name(std::string_view given, std::span<const std::string> known) {
  std::optional<std::string> best;
  for (const std::string &name : known)
    if (given.size() >= 3 && name.size() > given.size() && name.starts_with(given) &&
        name[given.size()] == '_' && (!best || name.size() < best->size()))
      best = name;
  return best;
}

/// The nearest of those that share a word ("solar_cell": "cell_gaas"); empty if none.
std::optional<std::string> kindred_name(std::string_view given,
                                        std::span<const std::string> known) {
  const auto wanted = words_of(given);
  std::optional<std::string> best;
  for (const std::string &name : known) {
    const auto words = words_of(name);
    const bool is_kindred =
        std::ranges::any_of(words, [&](const auto &w) { return wanted.contains(w); });
    if (is_kindred && (!best || edit_distance(given, name) < edit_distance(given, *best)))
      best = name;
  }
  return best;
}

} // namespace

std::optional<std::string> nearest_name(std::string_view given,
                                        std::span<const std::string> known) {
  // Nobody mistypes so much, and a distance takes the product of both lengths.
  constexpr std::size_t longest = 256;
  if (given.size() > longest)
    return {};
  if (auto longer = longer_name(given, known))
    return longer;
  const std::size_t reach = std::max<std::size_t>(2, given.size() / 3);
  std::optional<std::string> best;
  std::size_t best_distance = reach + 1, best_start = 0;
  for (const std::string &name : known) {
    const std::size_t distance = edit_distance(given, name);
    const auto start = static_cast<std::size_t>(
        std::mismatch(given.begin(), given.end(), name.begin(), name.end()).first - given.begin());
    if (distance < best_distance || (best && distance == best_distance && start > best_start)) {
      best_distance = distance;
      best_start = start;
      best = name;
    }
  }
  return best ? best : kindred_name(given, known);
}

std::string shortest(double value) {
  if (std::isnan(value))
    return "nan"; // one spelling, whatever the sign bit
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string degrees_text(Angle angle) {
  const double degrees = angle.degrees();
  std::array<char, 40> buffer{};
  for (int digits = 15; digits < 17; ++digits) {
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), degrees,
                                   std::chars_format::general, digits)
                         .ptr;
    double back = 0;
    std::from_chars(buffer.data(), end, back);
    if (Angle::degrees(back).radians() == angle.radians())
      return shortest(back);
  }
  return shortest(degrees);
}

std::string counted(std::size_t count, std::string_view singular, std::string_view plural) {
  std::string out = std::to_string(count) + " ";
  if (count == 1 || plural.empty())
    return out.append(singular) + (count == 1 ? "" : "s");
  return out.append(plural);
}

std::string listed(std::span<const std::string> names, std::size_t most) {
  std::string out;
  for (const std::string &name : names.first(std::min(most, names.size())))
    out += (out.empty() ? "" : ", ") + name;
  if (names.size() > most)
    out += " and " + std::to_string(names.size() - most) + " more";
  return out;
}

std::string percent(double share) {
  std::array<char, 320> text{}; // of any double
  const double value = 100 * share;
  const auto end =
      value < 10 ? std::to_chars(text.begin(), text.end(), value, std::chars_format::general, 2)
                 : std::to_chars(text.begin(), text.end(), value, std::chars_format::fixed, 0);
  return {text.begin(), end.ptr};
}

std::string lowered(std::string_view text) {
  std::string out(text);
  for (char &c : out)
    if (c >= 'A' && c <= 'Z')
      c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos)
    return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::optional<std::vector<CsvCell>> csv_cells(std::string_view line) {
  std::vector<CsvCell> cells(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (is_quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"')
      cells.back().text += line[i++];
    else if (c == '"')
      is_quoted = !is_quoted;
    else if (c == ',' && !is_quoted)
      cells.push_back({"", i + 2});
    else
      cells.back().text += c;
  }
  if (is_quoted)
    return std::nullopt;
  for (CsvCell &cell : cells)
    cell.text = std::string(trimmed(cell.text));
  return cells;
}

namespace {

/// Bytes of the UTF-8 character at the start of `text` (RFC 3629, section 4: neither overlong forms
/// nor surrogates), else 0.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  const std::size_t length = lead < 0x80                   ? 1
                             : lead >= 0xC2 && lead < 0xE0 ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || length > text.size())
    return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80)
      return 0;
  const bool is_wrong =
      length > 2 && ((lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xED && byte(1) >= 0xA0) ||
                     (lead == 0xF0 && byte(1) < 0x90) || (lead == 0xF4 && byte(1) >= 0x90));
  return is_wrong ? 0 : length;
}

/// Control characters of ASCII and of ISO 6429 (U+0080 to U+009F), which terminals obey.
bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  return first < 0x20 || first == 0x7F ||
         (first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0);
}

} // namespace

std::string printable(std::string_view text, bool *is_changed) {
  std::string out;
  bool is_other = false;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const bool is_fine = length > 0 && !is_control(text.substr(0, length));
    if (is_fine)
      out += text.substr(0, length);
    else
      out += '?';
    is_other = is_other || !is_fine;
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  if (is_changed != nullptr)
    *is_changed = is_other;
  return out;
}

std::optional<std::string> why_no_text(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\x1F\x8B"))
    return "is compressed (gzip); unpack it first: gunzip";
  if (bytes.starts_with("PK\x03\x04"))
    return "is a ZIP archive (or a spreadsheet, which is one); unpack it, or save it as text";
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF"))
    return "is text in UTF-16; save it as UTF-8";
  constexpr std::size_t looked_at = 1u << 16;
  if (const std::size_t zero = bytes.substr(0, looked_at).find("\0"sv);
      zero != std::string_view::npos)
    return "is no text: byte " + std::to_string(zero + 1) + " is 0. Is it another file?";
  return std::nullopt;
}

std::string sha256_hex(std::string_view bytes) {
  std::array<unsigned char, 32> digest{};
  unsigned length = 0;
  // It fails for want of memory alone: it would leave the hash of nothing, and ends the program
  // where what it begins with could not be made.
  if (OSSL_LIB_CTX_get0_global_default() == nullptr ||
      EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1)
    throw std::bad_alloc();
  constexpr std::string_view digits = "0123456789abcdef";
  std::string out;
  for (const unsigned char byte : digest) {
    out += digits[byte >> 4];
    out += digits[byte & 15];
  }
  return out;
}

} // namespace umov
