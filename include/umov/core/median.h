#pragma once
// The middle of numbers.

#include <algorithm>
#include <vector>

namespace umov {

/// The middle one by size, of an even number the upper of the two in the middle; `values` is not
/// empty.
inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace umov
