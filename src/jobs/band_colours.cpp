#include "jobs/band_colours.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <umov/io/passband_file.h>

namespace umov::jobs {

std::vector<std::size_t> band_colours(const std::vector<std::string> &names) {
  constexpr std::array<std::size_t, 3> of_three{4, 2, 5}; // blue, green, vermilion
  constexpr std::array<std::size_t, 7> of_many{4, 1, 2, 0, 5, 6, 3};
  std::vector<double> nm;
  for (const std::string &name : names) {
    const auto known = bands_named({name});
    if (!known || known->size() != 1)
      break;
    nm.push_back(known->front().wavelength.nm());
  }
  std::vector<std::size_t> order(names.size()), out(names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (nm.size() == names.size())
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return nm[k]; });
  for (std::size_t rank = 0; rank < order.size(); ++rank)
    out[order[rank]] =
        names.size() <= of_three.size() ? of_three[rank] : of_many[rank % of_many.size()];
  return out;
}

} // namespace umov::jobs
