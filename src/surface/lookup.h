#pragma once
// Private: place of a value in an increasing list.

#include <umov/core/result.h>
#include <vector>

namespace umov {

/// Between entries `low` and `high`, at the fraction t.
struct Segment {
  std::size_t low = 0, high = 0;
  double t = 0;
};

/// Where `at` lies in `x`; an empty list means a constant (entry 0). Fails, with an empty message
/// for the caller to fill, outside the list.
Result<Segment> find_segment(const std::vector<double> &x, double at);

} // namespace umov
