#pragma once
// Private: a few epochs that stand for a curve.

#include <algorithm>
#include <vector>

namespace umov::inverse {

/// Every n-th epoch, `count` of them at most, the ends among them.
inline std::vector<std::size_t> some_epochs(std::size_t epochs, std::size_t count) {
  std::vector<std::size_t> out;
  count = std::min(count, epochs);
  out.reserve(count);
  for (std::size_t k = 0; k < count; ++k)
    out.push_back(count < 2 ? 0 : k * (epochs - 1) / (count - 1));
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

} // namespace umov::inverse
