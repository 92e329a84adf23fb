#include "inverse/sample_weights.h"

#include <algorithm>
#include <cmath>

namespace umov::inverse {

double normalize(std::vector<PoseSample> &draws, std::vector<double> log_weight) {
  for (double &one : log_weight)
    one = one > no_weight ? one : no_weight;
  const double highest = *std::ranges::max_element(log_weight);
  double sum = 0;
  for (std::size_t k = 0; k < draws.size(); ++k)
    sum += draws[k].weight = std::exp(log_weight[k] - highest);
  for (PoseSample &s : draws)
    s.weight /= sum;
  return highest + std::log(sum);
}

double effective_size(const std::vector<PoseSample> &draws) {
  double squares = 0;
  for (const PoseSample &s : draws)
    squares += s.weight * s.weight;
  return squares > 0 ? 1 / squares : 0;
}

std::vector<double> to_power(const std::vector<double> &log_weights, double power) {
  const double highest = *std::ranges::max_element(log_weights);
  std::vector<double> out;
  out.reserve(log_weights.size());
  for (const double w : log_weights)
    out.push_back(w > no_weight ? std::exp(power * (w - highest)) : 0);
  return out;
}

double worth(const std::vector<double> &weights) {
  double sum = 0, squares = 0;
  for (const double w : weights) {
    sum += w;
    squares += w * w;
  }
  return sum * sum / squares;
}

double power_worth(const std::vector<double> &log_weights, double most, double wanted) {
  if (worth(to_power(log_weights, most)) >= wanted)
    return most;
  double low = 0, high = most;
  constexpr int halvings = 40;
  for (int k = 0; k < halvings; ++k) {
    const double middle = (low + high) / 2;
    (worth(to_power(log_weights, middle)) >= wanted ? low : high) = middle;
  }
  return low;
}

} // namespace umov::inverse
