#pragma once
// Private: what the parser of a library says of a text, as a message of ours has it.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace umov {

/// Line and column of a byte of a text, both from 1; of its end for one beyond it.
std::pair<std::size_t, std::size_t> line_and_column(std::string_view text, std::size_t byte);

/// What nlohmann's JSON says of a problem, without the name of the exception in brackets,
/// printable.
std::string json_words(std::string_view what);

} // namespace umov
