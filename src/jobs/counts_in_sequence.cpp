#include "jobs/counts_in_sequence.h"

#include <algorithm>

namespace umov::jobs {

std::map<std::size_t, std::vector<const ObservedCount *>>
counts_in_sequence(const ObservedCurve &curve) {
  std::map<std::size_t, std::vector<const ObservedCount *>> out;
  for (const ObservedCount &count : curve.counts)
    if (count.set != no_set)
      out[count.set].push_back(&count);
  std::erase_if(out, [](const auto &set) {
    return std::ranges::all_of(set.second, [&](const ObservedCount *count) {
      return count->epoch == set.second.front()->epoch;
    });
  });
  return out;
}

} // namespace umov::jobs
