#include "paper/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace umov {
namespace {

std::vector<double> ranks(const std::vector<double> &values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> out(values.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    out[order[k]] = static_cast<double>(k);
  return out;
}

} // namespace

double quantile(std::vector<double> values, double share) {
  if (values.empty())
    return std::nan("");
  const auto at = std::min(values.size() - 1,
                           static_cast<std::size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

double rank_correlation(const std::vector<double> &a, const std::vector<double> &b) {
  const std::size_t n = std::min(a.size(), b.size());
  if (n < 3)
    return std::nan("");
  const auto x = ranks(a), y = ranks(b);
  const double mean = static_cast<double>(n - 1) / 2;
  double xy = 0, xx = 0, yy = 0;
  for (std::size_t i = 0; i < n; ++i) {
    xy += (x[i] - mean) * (y[i] - mean);
    xx += (x[i] - mean) * (x[i] - mean);
    yy += (y[i] - mean) * (y[i] - mean);
  }
  return xy / std::sqrt(xx * yy);
}

} // namespace umov
