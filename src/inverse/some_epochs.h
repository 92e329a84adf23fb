#pragma once
// Private: a few epochs that stand for a curve.

#include <algorithm>
#include <umov/core/random.h>
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

/// An epoch of each of `count` even stretches (all epochs, if there are no more), anywhere in it
/// (jittered sampling: Cook 1986, ACM Trans. Graphics 5, 51): even steps, and such in a golden
/// section too, can meet a body that turns in one and the same phase. The same epochs every time.
inline std::vector<std::size_t> epochs_out_of_step(std::size_t epochs, std::size_t count) {
  if (epochs <= count)
    return some_epochs(epochs, count);
  std::vector<std::size_t> out;
  out.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = k * epochs / count, end = (k + 1) * epochs / count;
    const double into = uniform4(0, 0, k)[0] * static_cast<double>(end - begin);
    out.push_back(std::min(begin + static_cast<std::size_t>(into), end - 1));
  }
  return out;
}

} // namespace umov::inverse
