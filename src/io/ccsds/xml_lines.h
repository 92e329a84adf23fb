#pragma once
// Private: lines of byte offsets, for messages about XML.

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

namespace umov {

class XmlLines {
public:
  explicit XmlLines(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n')
        ends_.push_back(i);
  }
  /// From 1.
  [[nodiscard]] std::size_t of(std::ptrdiff_t offset) const {
    const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0));
    return static_cast<std::size_t>(std::lower_bound(ends_.begin(), ends_.end(), at) -
                                    ends_.begin()) +
           1;
  }

private:
  std::vector<std::size_t> ends_;
};

} // namespace umov
