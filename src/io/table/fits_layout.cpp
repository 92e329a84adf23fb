#include "io/table/fits_layout.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <fmt/format.h>
#include <map>
#include <umov/core/text.h>

namespace umov {
namespace {

constexpr std::size_t fits_block = 2880, fits_card = 80, fits_keyword = 8;
constexpr std::int64_t fits_most = std::int64_t{1}
                                   << 38; ///< of any count; what a file holds is below

std::size_t padded(std::size_t bytes) { return (bytes + fits_block - 1) / fits_block * fits_block; }

bool is_printable(char c) { return c >= ' ' && c <= '~'; }

/// Keyword of a card as CFITSIO tells it: up to a blank or '='.
std::string_view keyword_of(std::string_view card) {
  const std::string_view key = card.substr(0, fits_keyword);
  return key.substr(0, key.find_first_of(" ="));
}

bool is_count(std::string_view key) {
  constexpr std::array names{"BITPIX", "NAXIS", "PCOUNT", "GCOUNT", "TFIELDS"};
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return std::ranges::find(names, key) != names.end() ||
         (key.starts_with("NAXIS") && std::ranges::all_of(key.substr(5), is_digit));
}

/// Keywords that say where things lie.
bool is_structural(std::string_view key) {
  constexpr std::array names{"SIMPLE", "XTENSION", "THEAP", "GROUPS", "ZIMAGE", "END"};
  return is_count(key) || std::ranges::find(names, key) != names.end() ||
         key.starts_with("TFORM") || key.starts_with("TBCOL");
}

/// What stands behind "= " of a card: a text without its quotes, or up to the comment.
std::string_view value_of(std::string_view card) {
  std::string_view text = trimmed(card.substr(fits_keyword + 2));
  if (text.starts_with('\''))
    return text.substr(1, text.find('\'', 1) - 1);
  return trimmed(text.substr(0, text.find('/')));
}

/// One part: a header, and the data that it tells of.
class FitsPart {
public:
  FitsPart(std::string_view bytes, std::size_t number, const std::string &file)
      : bytes_(bytes), number_(number), file_(file) {}

  /// Adds header and data in whole blocks to those of the parts before.
  [[nodiscard]] Result<void> read(std::string &out) {
    UMOV_TRY(read_header());
    UMOV_ASSIGN(data, data_size());
    const std::size_t there = bytes_.size() - header_.size();
    if (data > there)
      return refuse(fmt::format("tells of {} bytes of data, of which {} are there", data, there));
    out += header_;
    out += bytes_.substr(header_.size(), data);
    out.resize(padded(out.size()), '\0');
    return {};
  }
  /// A table of rows; that of a compressed image, which CFITSIO reads as one, is none.
  [[nodiscard]] bool is_table() const { return is_table_ && !is_image_; }

private:
  [[nodiscard]] tl::unexpected<Error> refuse(const std::string &what) const {
    return fail(ErrorCode::BadInput,
                fmt::format("part {} of the FITS file {}: it was cut off or changed. Export or "
                            "fetch it again.",
                            number_, what),
                {file_});
  }
  [[nodiscard]] Result<void> read_header();
  [[nodiscard]] Result<void> take(std::string_view card);
  [[nodiscard]] Result<void> take_count(std::string_view card);
  [[nodiscard]] Result<std::int64_t> count(const std::string &key, std::int64_t low,
                                           std::int64_t high) const;
  [[nodiscard]] Result<std::int64_t> count_or(const std::string &key, std::int64_t low,
                                              std::int64_t fallback) const;
  [[nodiscard]] Result<std::int64_t> elements() const;
  [[nodiscard]] Result<std::size_t> data_size() const;

  std::string_view bytes_;
  std::size_t number_;
  const std::string &file_;
  std::string header_; ///< in whole blocks of printable ASCII
  std::map<std::string, std::int64_t, std::less<>> values_;
  bool is_table_ = false, is_image_ = false, has_groups_ = false;
};

Result<void> FitsPart::take_count(std::string_view card) {
  const std::string_view key = keyword_of(card);
  std::string_view text = value_of(card);
  const std::string told = printable(text.substr(0, 30));
  text.remove_prefix(text.starts_with('+') ? 1 : 0);
  std::int64_t value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size() ||
      card.substr(fits_keyword, 2) != "= ")
    return refuse(fmt::format("has {} = \"{}\", where a whole number was expected", key, told));
  values_.try_emplace(std::string(key), value); // the first holds
  return {};
}

/// Of a keyword that says where things lie its value, of others nothing.
Result<void> FitsPart::take(std::string_view card) {
  const std::string_view key = keyword_of(card);
  if (!is_structural(key))
    return {};
  if (!std::ranges::all_of(card, is_printable))
    return refuse(fmt::format("has bytes in {} that are no printable ASCII", key));
  if (is_count(key))
    return take_count(card);
  is_table_ =
      is_table_ || (key == "XTENSION" && value_of(card).find("TABLE") != std::string_view::npos);
  is_image_ = is_image_ || (key == "ZIMAGE" && value_of(card) == "T");
  has_groups_ = has_groups_ || (key == "GROUPS" && value_of(card) == "T");
  return {};
}

Result<void> FitsPart::read_header() {
  for (std::size_t at = 0; at + fits_card <= bytes_.size(); at += fits_card) {
    UMOV_TRY(take(bytes_.substr(at, fits_card)));
    for (const char c : bytes_.substr(at, fits_card))
      header_ += is_printable(c) ? c : static_cast<unsigned char>(c) < ' ' ? ' ' : '?';
    const std::string_view card = std::string_view(header_).substr(at);
    // CFITSIO ends a header at "END / words", and does not at "     END".
    const bool is_end = card.starts_with("END     ");
    if (!is_end && (keyword_of(card) == "END" || trimmed(card.substr(0, fits_keyword)) == "END"))
      return refuse(fmt::format("has \"{}\" in its header, where END alone was expected",
                                trimmed(card.substr(0, 30))));
    if (!is_end)
      continue;
    header_.resize(padded(header_.size()), ' ');
    return header_.size() <= bytes_.size() ? Result<void>() : refuse("has no room for its header");
  }
  return refuse("has a header without an END");
}

Result<std::int64_t> FitsPart::count(const std::string &key, std::int64_t low,
                                     std::int64_t high) const {
  const auto at = values_.find(key);
  if (at == values_.end())
    return refuse(fmt::format("has no {}", key));
  if (at->second < low || at->second > high)
    return refuse(
        fmt::format("has {} = {}, where {} was expected", key, at->second,
                    low == high ? fmt::format("{}", low) : fmt::format("{} to {}", low, high)));
  return at->second;
}

/// What images may leave out, and tables may not.
Result<std::int64_t> FitsPart::count_or(const std::string &key, std::int64_t low,
                                        std::int64_t fallback) const {
  return !is_table_ && !values_.contains(key) ? fallback : count(key, low, fits_most);
}

/// NAXIS1 NAXIS2 ...; without NAXIS1, which is 0, where there are random groups.
Result<std::int64_t> FitsPart::elements() const {
  constexpr std::int64_t most_axes = 999;
  UMOV_ASSIGN(axes, count("NAXIS", is_table_ ? 2 : 0, is_table_ ? 2 : most_axes));
  const bool has_groups = has_groups_ && axes > 0;
  if (has_groups)
    UMOV_TRY(count("NAXIS1", 0, 0));
  std::int64_t out = axes == 0 ? 0 : 1;
  for (std::int64_t k = has_groups ? 2 : 1; k <= axes; ++k) {
    UMOV_ASSIGN(length, count(fmt::format("NAXIS{}", k), 0, fits_most));
    if (length > 0 && out > fits_most / length)
      return refuse(fmt::format("has NAXIS{} = {}, more than any file holds", k, length));
    out *= length;
  }
  return out;
}

/// |BITPIX|/8 GCOUNT (PCOUNT + NAXIS1 NAXIS2 ...), equations 1, 2 and 4 of the standard.
Result<std::size_t> FitsPart::data_size() const {
  constexpr std::int64_t most_columns = 999;
  UMOV_ASSIGN(bits, count("BITPIX", -64, 64));
  if (bits % 8 != 0 || bits == 0)
    return refuse(fmt::format("has BITPIX = {}", bits));
  UMOV_ASSIGN(numbers, elements());
  UMOV_ASSIGN(extra, count_or("PCOUNT", 0, 0));
  UMOV_ASSIGN(groups, count_or("GCOUNT", 1, 1));
  if (numbers + extra > fits_most / groups)
    return refuse(fmt::format("has GCOUNT = {}, more than any file holds", groups));
  if (is_table_)
    UMOV_TRY(count("TFIELDS", 0, most_columns));
  return static_cast<std::size_t>((numbers + extra) * groups * (std::abs(bits) / 8));
}

} // namespace

Result<std::string> fits_up_to_table(std::string_view bytes, const std::string &file) {
  if (bytes.size() < fits_block)
    return fail(ErrorCode::BadInput,
                fmt::format("is shorter than a block of FITS, which has {} bytes: it was cut off. "
                            "Export or fetch it again.",
                            fits_block),
                {file});
  std::string out;
  bool has_table = false;
  // What follows the last part and is none has no meaning (FITS 4.0, 3.5).
  for (std::size_t number = 1; !has_table && out.size() < bytes.size() &&
                               (number == 1 || bytes.substr(out.size()).starts_with("XTENSION"));
       ++number) {
    FitsPart part(bytes.substr(out.size()), number, file);
    UMOV_TRY(part.read(out));
    has_table = part.is_table();
  }
  return out;
}

} // namespace umov
