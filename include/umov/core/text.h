#pragma once
// Small text tools that messages and parsers share.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <umov/core/quantity.h>
#include <vector>

namespace umov {

/// Finite decimal number that fills the whole of `text` (no hex, no "nan", no "inf", no overflow,
/// an optional sign); empty otherwise. Independent of the locale.
std::optional<double> parse_number(std::string_view text);

/// Edit distance with insertion, deletion, substitution and neighbour swap.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name nearest to `given` if near enough to be a slip (distance at most 2, or a third of its
/// length), else empty. Of equally near ones the one with the longest common beginning.
std::optional<std::string> nearest_name(std::string_view given, std::span<const std::string> known);

/// Shortest text that reads back to the same double ("nan" for NaN); independent of the locale.
std::string shortest(double value);

/// "1 epoch", "2 epochs"; `plural` where it is not just an s more.
std::string counted(std::size_t count, std::string_view singular, std::string_view plural = {});

/// "a, b and 3 more": the first `most` of `names`.
std::string listed(std::span<const std::string> names, std::size_t most);

/// Percent of a share: two digits below ten, else none, so that 99.7 is 100 and not 1e+02.
std::string percent(double share);

/// Shortest number of degrees that gives back the same angle, although the angle is kept in
/// radians.
std::string degrees_text(Angle angle);

/// `text` with the letters A to Z small.
std::string lowered(std::string_view text);

/// `text` without blanks and tabs at both ends.
std::string_view trimmed(std::string_view text);

/// One cell of a line of comma-separated values.
struct CsvCell {
  std::string text;       ///< without quotes and the blanks around it
  std::size_t column = 1; ///< first character, counted from 1
};

/// The cells of one line; quotes as in RFC 4180, no line break inside them. Empty if a quote stays
/// open.
std::optional<std::vector<CsvCell>> csv_cells(std::string_view line);

/// `text` with '?' for every byte that is no part of printable UTF-8: safe on a terminal, in a line
/// of a file and in JSON. `is_changed` tells of replaced bytes.
std::string printable(std::string_view text, bool *is_changed = nullptr);

/// Why `bytes` can be no text: compressed, UTF-16 or binary, with the remedy. Empty if they may be.
std::optional<std::string> why_no_text(std::string_view bytes);

/// SHA-256 of `bytes`, 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

} // namespace umov
