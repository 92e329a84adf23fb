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

constexpr std::size_t fits_block = 2880, fits_card = 80;
constexpr std::int64_t fits_most = std::int64_t{1}
                                   << 38; ///< of any count; what a file holds is below

/// One part: a header, and the data that it tells of.
class FitsPart {
public:
  FitsPart(std::string_view bytes, std::size_t number, const std::string &file)
      : bytes_(bytes), number_(number), file_(file) {}

  /// Bytes of header and data, in whole blocks.
  [[nodiscard]] Result<std::size_t> size() {
    UMOV_TRY(read_header());
    UMOV_ASSIGN(data, data_size());
    if (data > bytes_.size() - header_)
      return refuse(fmt::format("tells of {} bytes of data, of which {} are there", data,
                                bytes_.size() - header_));
    return header_ + padded(data);
  }

private:
  static std::size_t padded(std::size_t bytes) {
    return (bytes + fits_block - 1) / fits_block * fits_block;
  }
  [[nodiscard]] tl::unexpected<Error> refuse(const std::string &what) const {
    return fail(ErrorCode::BadInput,
                fmt::format("part {} of the FITS file {}: it was cut off or changed. Export or "
                            "fetch it again.",
                            number_, what),
                {file_});
  }
  [[nodiscard]] Result<void> read_header();
  [[nodiscard]] Result<void> take(std::string_view words);
  [[nodiscard]] Result<std::int64_t> count(const std::string &key, std::int64_t low,
                                           std::int64_t high) const;
  [[nodiscard]] Result<std::size_t> data_size() const;

  std::string_view bytes_;
  std::size_t number_, header_ = 0;
  const std::string &file_;
  std::map<std::string, std::int64_t, std::less<>> values_;
  bool is_table_ = false;
};

/// A card: of a mandatory keyword its number, of others nothing.
Result<void> FitsPart::take(std::string_view words) {
  if (std::ranges::any_of(words, [](char c) { return c < ' ' || c > '~'; }))
    return refuse(fmt::format("has bytes in its header that are no letters, in \"{}\"",
                              printable(trimmed(words.substr(0, 30)))));
  const std::string_view key = trimmed(words.substr(0, 8));
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  is_table_ = is_table_ || (key == "XTENSION" && words.find("TABLE") != std::string_view::npos);
  constexpr std::array names{"BITPIX", "NAXIS", "PCOUNT", "GCOUNT", "TFIELDS"};
  if (std::ranges::find(names, key) == names.end() &&
      !(key.starts_with("NAXIS") && std::ranges::all_of(key.substr(5), is_digit)))
    return {};
  std::string_view text = trimmed(words.substr(10, words.find('/', 10) - 10));
  text.remove_prefix(text.starts_with('+') ? 1 : 0);
  std::int64_t value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size() || words.substr(8, 2) != "= ")
    return refuse(fmt::format("has {} = \"{}\", where a whole number was expected", key,
                              printable(text.substr(0, 30))));
  values_.try_emplace(std::string(key), value); // the first holds
  return {};
}

Result<void> FitsPart::read_header() {
  for (std::size_t at = 0; at + fits_card <= bytes_.size(); at += fits_card) {
    const std::string_view words = bytes_.substr(at, fits_card);
    if (trimmed(words) == "END") {
      header_ = padded(at + fits_card);
      return header_ <= bytes_.size() ? Result<void>() : refuse("has no room for its header");
    }
    UMOV_TRY(take(words));
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
        fmt::format("has {} = {}, where {} to {} was expected", key, at->second, low, high));
  return at->second;
}

/// |BITPIX|/8 GCOUNT (PCOUNT + NAXIS1 NAXIS2 ...), equations 1 and 2 of the standard.
Result<std::size_t> FitsPart::data_size() const {
  constexpr std::int64_t most_axes = 999;
  UMOV_ASSIGN(bits, count("BITPIX", -64, 64));
  UMOV_ASSIGN(axes, count("NAXIS", is_table_ ? 2 : 0, is_table_ ? 2 : most_axes));
  if (bits % 8 != 0 || bits == 0)
    return refuse(fmt::format("has BITPIX = {}", bits));
  std::int64_t elements = axes == 0 ? 0 : 1, extra = 0, groups = 1;
  for (std::int64_t k = 1; k <= axes; ++k) {
    UMOV_ASSIGN(length, count(fmt::format("NAXIS{}", k), 0, fits_most));
    if (length > 0 && elements > fits_most / length)
      return refuse(fmt::format("has NAXIS{} = {}, more than any file holds", k, length));
    elements *= length;
  }
  if (number_ > 1) {
    UMOV_ASSIGN(more, count("PCOUNT", 0, fits_most));
    UMOV_ASSIGN(times, count("GCOUNT", 1, 1 << 16));
    extra = more;
    groups = times;
  }
  if (is_table_)
    UMOV_TRY(count("TFIELDS", 0, most_axes));
  return static_cast<std::size_t>((elements + extra) * groups * (std::abs(bits) / 8)); // below 2^58
}

} // namespace

Result<std::size_t> fits_size(std::string_view bytes, const std::string &file) {
  bytes = bytes.substr(0, bytes.size() / fits_block * fits_block);
  std::size_t at = 0;
  // What follows the last part and is none has no meaning (FITS 4.0, 3.5).
  for (std::size_t number = 1;
       at < bytes.size() && (number == 1 || bytes.substr(at).starts_with("XTENSION")); ++number) {
    UMOV_ASSIGN(size, FitsPart(bytes.substr(at), number, file).size());
    at += size;
  }
  if (at == 0)
    return fail(ErrorCode::BadInput,
                fmt::format("is shorter than a block of FITS, which has {} bytes: it was cut off. "
                            "Export or fetch it again.",
                            fits_block),
                {file});
  return std::min(at, bytes.size());
}

} // namespace umov
