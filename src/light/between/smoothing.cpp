#include "light/between/smoothing.h"

#include "light/between/replicates.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace umov {
namespace {

/// Places on either side; the first is the value alone.
constexpr std::array<std::size_t, 7> halves{0, 2, 4, 8, 16, 32, 64};
/// Standard deviations within which estimates agree.
constexpr double agreement = 1.3;
/// What choosing the window by the values adds to a half-width (measured: docs/theory/bounces.md).
constexpr double choice = 1.5;

/// Weights of the values for that of a parabola at `centre`; empty if they do not determine one.
std::vector<double> parabola_weights(std::span<const double> place, std::span<const double> draws,
                                     double centre) {
  const double scale = std::max(std::abs(place.front() - centre), std::abs(place.back() - centre));
  if (!(scale > 0)) { // all at one place: their mean
    const double all = std::accumulate(draws.begin(), draws.end(), 0.0);
    std::vector<double> out(draws.begin(), draws.end());
    for (double &weight : out)
      weight /= all;
    return out;
  }
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  std::vector<Eigen::Vector3d> row;
  for (std::size_t j = 0; j < place.size(); ++j) {
    const double t = (place[j] - centre) / scale;
    row.emplace_back(1, t, t * t);
    normal += draws[j] * row.back() * row.back().transpose();
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> solver(normal);
  if (!solver.isInvertible() || solver.rcond() < 1e-8)
    return {};
  const Eigen::Vector3d by = solver.solve(Eigen::Vector3d::UnitX());
  std::vector<double> out;
  for (std::size_t j = 0; j < place.size(); ++j)
    out.push_back(draws[j] * row[j].dot(by));
  return out;
}

} // namespace

LocalFits::LocalFits(std::span<const double> place, std::span<const double> draws, double reach)
    : places_(place.size()), windows_(place.size()) {
  for (std::size_t k = 0; k < places_; ++k) {
    std::vector<Window> &of = windows_[k];
    for (const std::size_t half : halves) {
      std::size_t first = k, last = k;
      while (first > 0 && k - first < half && place[k] - place[first - 1] <= reach)
        --first;
      while (last + 1 < places_ && last - k < half && place[last + 1] - place[k] <= reach)
        ++last;
      const std::size_t count = last - first + 1;
      if (half > 0 && count < 4) // an end: wider ones hold more on the other side
        continue;
      if (half > 0 && count <= of.back().weight.size())
        break;
      Window window{first, {1}, 0};
      if (half > 0)
        window.weight =
            parabola_weights(place.subspan(first, count), draws.subspan(first, count), place[k]);
      if (window.weight.empty())
        break;
      for (std::size_t j = 0; j < count; ++j)
        window.draws += draws[first + j];
      of.push_back(std::move(window));
    }
  }
}

Smoothed LocalFits::at(std::size_t k, std::span<const double> value, std::size_t widest) const {
  Smoothed out;
  double low = -INFINITY, high = INFINITY;
  std::vector<double> means(value.size() / places_);
  for (std::size_t w = 0; w < windows_[k].size() && w <= widest; ++w) {
    const Window &window = windows_[k][w];
    for (std::size_t r = 0; r < means.size(); ++r) {
      means[r] = 0;
      for (std::size_t j = 0; j < window.weight.size(); ++j)
        means[r] += window.weight[j] * value[r * places_ + window.first + j];
    }
    const auto [mean, deviation] = mean_of_replicates(means);
    // Few draws that found nothing at all do not say that there is nothing.
    if (mean != 0 || deviation != 0 || window.draws >= trusted_draws) {
      low = std::max(low, mean - agreement * deviation);
      high = std::min(high, mean + agreement * deviation);
    }
    if (low > high)
      break;
    const double widening = window.weight.size() > 1 ? choice : 1;
    out = {mean, widening * student_of_replicates * deviation, window.draws, w};
  }
  return out;
}

} // namespace umov
