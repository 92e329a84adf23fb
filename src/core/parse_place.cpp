#include "core/parse_place.h"

#include <algorithm>
#include <umov/core/text.h>

namespace umov {

std::pair<std::size_t, std::size_t> line_and_column(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte);
  const std::size_t end = before.rfind('\n');
  return {1 + static_cast<std::size_t>(std::ranges::count(before, '\n')),
          before.size() - (end == std::string_view::npos ? 0 : end + 1) + 1};
}

std::string json_words(std::string_view what) {
  const std::size_t end = what.find("] ");
  return printable(what.substr(end == std::string_view::npos ? 0 : end + 2));
}

} // namespace umov
