// Filters of a posterior that is samples.

#include "inverse/attitude_set.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <umov/core/quantity.h>
#include <umov/inverse/track.h>

namespace umov {

std::vector<TrackMode> track_modes_around(std::vector<PoseSample> samples, double rate_sd,
                                          bool is_absolute, std::size_t bands,
                                          const std::vector<PartKind> &parts,
                                          const CurveErrors &errors) {
  constexpr std::size_t most = 4000;
  constexpr double left_out = 1e-3;
  std::ranges::stable_sort(samples, std::greater<>(), &PoseSample::weight);
  double held = 0;
  std::size_t kept = 0;
  while (kept < std::min(most, samples.size()) && held < 1 - left_out)
    held += samples[kept++].weight;
  samples.resize(kept);
  std::vector<TrackMode> out;
  if (kept == 0)
    return out;
  // As of the balls of a set: four neighbours lie within, lone ones have theirs in other places.
  constexpr std::size_t fourth = 4;
  auto apart = inverse::neighbour_distances(
      samples, std::min(fourth, std::max<std::size_t>(kept, 2) - 1), 0);
  std::vector<double> sorted = apart;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(kept / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  constexpr double part = 0.5, least = 0.1 * pi / 180; // of that distance each is wide
  for (std::size_t k = 0; k < kept; ++k) {
    const double sd = std::max(part * std::min(apart[k], 3 * *middle), least);
    std::vector<double> covariance(36, 0);
    for (std::size_t a = 0; a < 6; ++a)
      covariance[7 * a] = a < 3 ? sd * sd : rate_sd * rate_sd;
    TrackMode mode = track_mode(samples[k].turning, covariance, samples[k].scale, is_absolute,
                                bands, parts, errors);
    mode.number = k + 1;
    mode.log_weight = std::log(samples[k].weight / held);
    out.push_back(std::move(mode));
  }
  return out;
}

} // namespace umov
