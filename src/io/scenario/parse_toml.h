#pragma once
// Private: text of TOML to a table, or to what is wrong with it.

#include <string>
#include <string_view>
#include <toml++/toml.h>
#include <umov/core/result.h>

namespace umov::scenario {

/// Names that a dotted key may have. The parser goes one call deeper for each, without an end of
/// its own (lists and tables in braces it ends at 256).
inline constexpr std::size_t names_max = 64;

/// A dotted key of too many names, in a text that need not be TOML otherwise.
Result<void> check_key_depth(std::string_view text, const std::string &file);

/// BadInput with the place for what is no TOML, with how such a thing is mended.
Result<toml::table> parse_toml(std::string_view text, const std::string &file);

} // namespace umov::scenario
