#include "inverse/attitude_set.h"

#include "inverse/chords.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <umov/core/parallel.h>
#include <umov/core/quantity.h>
#include <umov/inverse/attitude_grid.h>
#include <utility>

namespace umov::inverse {
namespace {

constexpr double same_attitude = 1e-7; // rad

Chords chords_of(const std::vector<PoseSample> &draws) {
  Chords out;
  for (const PoseSample &s : draws)
    out.add(s.turning.attitude);
  return out;
}

} // namespace

std::vector<double> neighbour_distances(const std::vector<PoseSample> &draws, std::size_t rank,
                                        unsigned threads) {
  const Chords all = chords_of(draws);
  const double same = chord_square(same_attitude);
  std::vector<double> out(draws.size(), pi);
  parallel_for(draws.size(), threads, [&](std::size_t k) {
    std::vector<double> squares;
    all.squares_from(all.at(k), squares);
    std::vector<double> nearest(std::max<std::size_t>(rank, 1), 1e300); // rising
    for (const double square : squares)
      if (square < nearest.back() && square > same) {
        nearest.back() = square;
        for (std::size_t j = nearest.size() - 1; j > 0 && nearest[j] < nearest[j - 1]; --j)
          std::swap(nearest[j], nearest[j - 1]);
      }
    if (nearest.back() < 1e300)
      out[k] = angle_of_chord_square(nearest.back());
  });
  return out;
}

namespace {

constexpr double held_share = 0.95;

/// How large a ball may be: one standard deviation of the mode that its sample belongs to.
double width_at(Quaternion attitude, std::span<const PoseMode> modes) {
  double least = 1e300, width = 0;
  for (const PoseMode &mode : modes)
    if (const double d = angle_between(mode.turning.attitude, attitude) / mode.sd_rad();
        d < least) {
      least = d;
      width = mode.sd_rad();
    }
  return width;
}

/// How many balls must grow by for one of another run to reach a sample, at most.
double growth_to(const PoseSample &sample, std::size_t run, const Chords &places,
                 const std::vector<AttitudeBall> &set, const std::vector<std::size_t> &run_of) {
  std::vector<double> squares;
  places.squares_from(sample.turning.attitude, squares);
  double least = most_growth;
  for (std::size_t j = 0; j < set.size(); ++j) {
    // An angle is twice its chord or more: most are too far to be asked how far.
    const double reach = least * set[j].radius_rad / 2;
    if (squares[j] < reach * reach && run_of[j] != run)
      least = std::min(least, angle_of_chord_square(squares[j]) / set[j].radius_rad);
  }
  return least;
}

/// By how much balls must grow to hold 95 % of the weight of samples of other run_of.
double growth_of(const std::vector<PoseSample> &samples, const std::vector<AttitudeBall> &set,
                 const std::vector<std::size_t> &run_of, std::span<const std::size_t> runs) {
  std::vector<std::pair<double, double>> all(samples.size()); // growth, weight
  Chords places;
  for (const AttitudeBall &ball : set)
    places.add(ball.attitude);
  parallel_for(samples.size(), 0, [&](std::size_t k) {
    all[k] = {growth_to(samples[k], runs.empty() ? k : runs[k], places, set, run_of),
              samples[k].weight};
  });
  std::ranges::stable_sort(all, {}, &std::pair<double, double>::first);
  double held = 0;
  for (const auto &[growth, weight] : all)
    if ((held += weight) >= held_share)
      return std::max(growth, 1.0);
  return 1;
}

} // namespace

AttitudeSet highest_density(const std::vector<PoseSample> &samples, std::span<const PoseMode> modes,
                            std::span<const std::size_t> runs) {
  std::vector<std::size_t> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return samples[k].minus_2_log; });
  double sum = 0;
  std::size_t count = 0;
  std::vector<PoseSample> inside;
  while (count < order.size() && sum < held_share) {
    inside.push_back(samples[order[count++]]);
    sum += inside.back().weight;
  }
  const auto apart =
      neighbour_distances(inside, std::min<std::size_t>(4, std::max<std::size_t>(count, 2) - 1), 0);
  std::vector<double> sorted = apart;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  AttitudeSet out;
  std::vector<std::size_t> run_of;
  for (std::size_t k = 0; k < inside.size(); ++k) {
    const Quaternion q = inside[k].turning.attitude;
    const double largest = modes.empty() ? 3 * *middle : width_at(q, modes);
    if (!out.balls.empty() && angle_between(q, out.balls.back().attitude) <= 1e-7)
      continue;
    out.balls.push_back({q, std::min(apart[k], largest)});
    run_of.push_back(runs.empty() ? order[k] : runs[order[k]]);
  }
  out.level = inside.back().minus_2_log;
  const bool has_others = std::ranges::any_of(run_of, [&](auto run) { return run != run_of[0]; });
  out.growth = has_others ? growth_of(samples, out.balls, run_of, runs) : 1;
  for (AttitudeBall &ball : out.balls)
    ball.radius_rad = std::min(ball.radius_rad * out.growth, pi);
  return out;
}

double share_of(std::span<const AttitudeBall> set) {
  Chords places;
  std::vector<double> reach;
  for (const AttitudeBall &ball : set) {
    places.add(ball.attitude);
    reach.push_back(chord_square(std::min(ball.radius_rad, pi)));
  }
  std::vector<double> parts(set.size());
  parallel_for(set.size(), 0, [&](std::size_t k) {
    // Each place counts once: a ball's volume over the number of balls that hold its centre.
    std::vector<double> squares;
    places.squares_from(set[k].attitude, squares);
    double holders = 0;
    for (std::size_t j = 0; j < set.size(); ++j)
      holders += squares[j] <= reach[j] ? 1 : 0;
    parts[k] = share_within(set[k].radius_rad) / std::max(holders, 1.0);
  });
  return std::min(std::accumulate(parts.begin(), parts.end(), 0.0), 1.0);
}

} // namespace umov::inverse
