#include "inverse/model_error.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace umov::inverse {
namespace {

/// A larger floor takes its share of the median and of q and u along, as long as it says more of
/// bright light than of faint.
CurveErrors with_floor(CurveErrors errors, double floor) {
  const double known = errors.of_median();
  if (errors.floor > 0 && floor > errors.floor) {
    const double times = floor / errors.floor;
    errors.floor_median = std::max(known, std::min(known * times, floor / 2));
    if (errors.floor_q >= 0)
      errors.floor_q *= times;
  } else if (errors.floor > 0) {
    errors.floor_median = known;
  } else if (errors.floor_median < 0) {
    errors.floor_median = floor / 2; // as of the least floor that is none
  }
  errors.floor = floor;
  return errors;
}

/// Residuals of I by band and epoch.
using Residuals = std::map<std::size_t, std::map<std::size_t, double>>;

Residuals by_place(const CurveLikelihood &likelihood, const std::vector<double> &residuals) {
  Residuals out;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> count;
  for (const auto &place : likelihood.places()) {
    double sum = 0;
    for (std::size_t k = 0; k < place.size; ++k)
      sum += residuals[place.begin + k];
    out[place.band][place.epoch] += sum;
    count[{place.band, place.epoch}] += place.size;
  }
  for (auto &[band, all] : out)
    for (auto &[epoch, value] : all)
      value /= std::sqrt(static_cast<double>(count[{band, epoch}]));
  return out;
}

/// A correlation, less what chance gives one of none in one case of six.
double beyond_chance(double products, double pairs, double mean_square) {
  if (!(pairs > 4) || !(mean_square > 0))
    return 0;
  return std::clamp(products / pairs / mean_square - 1 / std::sqrt(pairs), 0.0, 0.95);
}

/// How many residuals are as good as one: those of one epoch in all bands, and of epochs that
/// follow each other as in a process whose correlation falls with a power of their distance.
double related(const Residuals &residuals) {
  double square = 0, count = 0, in_time = 0, in_time_pairs = 0, in_bands = 0, in_bands_pairs = 0;
  for (const auto &[band, all] : residuals) {
    const double *before = nullptr;
    for (const auto &[epoch, value] : all) {
      square += value * value;
      count += 1;
      if (before != nullptr) {
        in_time += *before * value;
        in_time_pairs += 1;
      }
      before = &value;
      for (const auto &[other_band, others] : residuals)
        if (const auto same = others.find(epoch); other_band < band && same != others.end()) {
          in_bands += value * same->second;
          in_bands_pairs += 1;
        }
    }
  }
  if (!(count > 0))
    return 1;
  const double mean = square / count;
  const double time = beyond_chance(in_time, in_time_pairs, mean);
  const double bands = beyond_chance(in_bands, in_bands_pairs, mean);
  const auto others = static_cast<double>(residuals.size()) - 1;
  return (1 + time) / (1 - time) * (1 + others * bands);
}

} // namespace

bool find_model_error(const CurveModel &model, const CurveErrors &asked, double largest,
                      std::span<const Turning> turnings, unsigned threads, ModelError &out) {
  constexpr double first = 0.1, step = 1.25;
  std::vector<CurveLikelihood> with;
  std::vector<double> floors;
  for (double floor = std::max(first * asked.floor, 1e-3); floor < largest * step; floor *= step) {
    floors.push_back(std::min(floor, largest));
    with.emplace_back(model.curve(), with_floor(asked, floors.back()));
  }
  // The light is the same whatever it is held against.
  std::vector<std::vector<Comparison>> compared(turnings.size());
  if (!model.for_each(turnings, {}, threads, [&](std::size_t k, const ModelLight &light) {
        for (const CurveLikelihood &likelihood : with)
          compared[k].push_back(likelihood.compare(light));
      }))
    return false;
  double least = 1e300;
  for (std::size_t f = 0; f < with.size(); ++f)
    for (const std::vector<Comparison> &one : compared)
      if (const double value = one[f].minus_2_log + with[f].log_variance(); value < least) {
        least = value;
        out.found = floors[f];
        out.chi2 = one[f].chi2;
        out.related = related(by_place(with[f], one[f].residuals));
      }
  out.errors = with_floor(asked, std::max(asked.floor, out.found * std::sqrt(out.related)));
  return true;
}

} // namespace umov::inverse
