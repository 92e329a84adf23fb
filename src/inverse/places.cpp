#include "inverse/places.h"

#include "inverse/pose_modes.h"
#include "inverse/some_epochs.h"
#include "inverse/tempered.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <umov/core/constants.h>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {
namespace {

/// Fits closer than that are dents of one place.
constexpr double place_wide = 2 * degree;

/// A few steps of many attitudes.
struct FewSteps {
  double floor; ///< of I, that is forgiven
  std::size_t epochs;
  int steps;
};

/// Fits of a round, best first; empty if it was stopped.
std::vector<TurningFit> fits_of(const FewSteps &round, const CurveModel &model,
                                std::vector<Turning> from, const SearchOptions &options) {
  const ObservedCurve &curve = model.curve();
  const auto epochs = epochs_out_of_step(curve.epochs.size(), round.epochs);
  const CurveLikelihood likelihood(curve, tempered(options.errors, curve, round.floor), epochs);
  return fit_turnings(model, likelihood, std::move(from), epochs,
                      on_the_way(round.steps, 2e-3, options.threads));
}

/// The kth of points that fill a ball evenly (additive recurrence of three numbers: Roberts 2018,
/// "The unreasonable effectiveness of quasirandom sequences").
Step point_in_ball(std::size_t k) {
  constexpr double radius = 3 * degree;
  constexpr double g = 1.2207440846057596; // g^4 = g + 1
  const auto part = [&](int power) {
    const double x = 0.5 + static_cast<double>(k + 1) / std::pow(g, power);
    return x - std::floor(x);
  };
  const double r = radius * std::cbrt(part(1)), z = 1 - 2 * part(2), a = 2 * pi * part(3);
  const double across = r * std::sqrt(1 - z * z);
  return Eigen::Vector3d(across * std::cos(a), across * std::sin(a), r * z);
}

/// The best few of many attitudes around each place; empty if it was stopped.
std::vector<Turning> look_around(const CurveModel &model, const CurveLikelihood &likelihood,
                                 const std::vector<Turning> &places, unsigned threads) {
  constexpr std::size_t looked_at = 48, kept = 3; // around each place
  const double span = span_of(model.curve());
  std::vector<Turning> near;
  for (const Turning &place : places)
    for (std::size_t k = 0; k < looked_at; ++k)
      near.push_back(stepped(place, point_in_ball(k), span));
  const auto compared = compare_all(model, likelihood, near, {}, threads);
  std::vector<Turning> out;
  for (std::size_t first = 0; first < compared.size(); first += looked_at) {
    std::vector<std::size_t> order(looked_at);
    std::iota(order.begin(), order.end(), first);
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return compared[k].chi2; });
    for (std::size_t k = 0; k < kept; ++k)
      out.push_back(near[order[k]]);
  }
  return out;
}

} // namespace

std::vector<Turning> cooled_places(const SearchModels &models, const std::vector<Turning> &sorted,
                                   std::size_t times, const SearchOptions &options) {
  const bool has_parts = !models.first.parts().empty(); // whose fits take many times as long
  constexpr std::size_t left = 600, last = 60;          // fits that go on; places
  const std::size_t first = has_parts ? 40 : 80, as_told = has_parts ? 40 : last;
  constexpr FewSteps forgiving{0.25, 20, 3}, strict{0.08, 60, 4}, of_parts{0.08, 20, 2};
  std::vector<Turning> out;
  const auto add = [&](const std::vector<TurningFit> &fits, std::size_t count) {
    const auto best = turnings_of(fits, count * times);
    out.insert(out.begin(), best.begin(), best.end()); // the best of the last round come first
    return !fits.empty();
  };
  const auto fits = fits_of(forgiving, models.quick,
                            spread_out(sorted, options.starts * times, 5 * degree), options);
  const auto from = turnings_of(fits, left * times);
  if (!add(fits, first) || !add(fits_of(strict, models.quick, from, options), as_told))
    return {};
  if (has_parts && !add(fits_of(of_parts, models.first, from, options), last))
    return {};
  return out;
}

std::vector<TurningFit> first_fits(const CurveModel &model, const CurveLikelihood &likelihood,
                                   const std::vector<Turning> &places, std::size_t most,
                                   unsigned threads) {
  const FitPlan steps = on_the_way(12, 1e-3, threads);
  auto out = fit_turnings(model, likelihood, places, {}, steps);
  if (model.parts().empty() || out.empty())
    return out;
  const auto apart = spread_out(turnings_of(out, out.size()), most / 2, place_wide);
  auto more =
      fit_turnings(model, likelihood, look_around(model, likelihood, apart, threads), {}, steps);
  if (more.empty())
    return {};
  out.insert(out.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  std::ranges::stable_sort(out, {}, [](const TurningFit &f) { return f.at.chi2; });
  return out;
}

std::vector<Turning> apart_first(const std::vector<Turning> &sorted, std::size_t count) {
  constexpr double same = 0.3 * degree; // fits that close end as one
  auto out = spread_out(sorted, count, place_wide);
  const std::size_t most = out.size() + count / 2;
  for (std::size_t k = 0; k < sorted.size() && out.size() < most; ++k)
    if (std::ranges::none_of(out, [&](const Turning &t) {
          return angle_between(t.attitude, sorted[k].attitude) < same;
        }))
      out.push_back(sorted[k]);
  return out;
}

bool are_many(const std::vector<TurningFit> &fits, double span_s) {
  constexpr double near = 20; // in chi-square
  constexpr std::size_t many = 10;
  const auto modes = modes_of(fits, span_s);
  if (modes.empty())
    return false;
  const double best = std::ranges::min(modes, {}, &PoseMode::chi2).chi2;
  std::vector<Turning> alike;
  for (const PoseMode &mode : modes)
    if (mode.chi2 < best + near)
      alike.push_back(mode.turning);
  return spread_out(alike, many, place_wide).size() == many;
}

} // namespace umov::inverse
