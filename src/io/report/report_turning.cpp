#include "io/report/report_turning.h"

#include <umov/lightcurve/periodogram.h>

#include <cmath>

namespace umov {
namespace {

using Json = nlohmann::ordered_json;

/// Periods and powers of one band of the epochs [first, last), with 5 digits; null where there are
/// too few.
Json band_json(const LightCurve &curve, std::size_t first, std::size_t last, std::size_t band) {
  std::vector<double> seconds, magnitudes;
  const std::size_t bands = curve.bands.size();
  for (std::size_t i = first; i < last; ++i) {
    const LightCurveSample &s = curve.samples[i * bands + band];
    if (!(s.intensity > 0) || has_magnitude_limit(s))
      continue;
    seconds.push_back(
        seconds_between(curve.epochs[i].geometry.time, curve.epochs[first].geometry.time));
    magnitudes.push_back(-2.5 * std::log10(s.intensity)); // without range and eclipse
  }
  constexpr std::size_t drawn = 2000;
  const Periodogram found = with_fewer_values(periodogram(seconds, magnitudes), drawn);
  if (found.power.empty())
    return nullptr;
  const auto rounded = [](const std::vector<double> &values) {
    Json out = Json::array();
    for (const double value : values)
      out.push_back(std::round(value * 1e5) / 1e5);
    return out;
  };
  return {{"period", rounded(found.period_s)},
          {"power", rounded(found.power)},
          {"best", found.best_s},
          {"start", to_iso(plus_seconds(curve.epochs[first].geometry.time, seconds.front()))},
          {"span_s", seconds.back() - seconds.front()},
          {"trend", found.trend}};
}

} // namespace

Json turning_json(const ReportInput &input) {
  if (input.turning.empty())
    return nullptr;
  Json periods = Json::array(), passes = Json::array();
  for (const TurningPeriod &period : input.turning)
    periods.push_back({{"name", period.name}, {"seconds", period.seconds}});
  const auto &epochs = input.curve.epochs;
  for (std::size_t first = 0, last = 0; first < epochs.size(); first = last) {
    while (last < epochs.size() && epochs[last].pass_id == epochs[first].pass_id)
      ++last;
    Json bands = Json::array();
    for (std::size_t band = 0; band < input.curve.bands.size(); ++band)
      bands.push_back(band_json(input.curve, first, last, band));
    passes.push_back({{"pass", epochs[first].pass_id}, {"bands", std::move(bands)}});
  }
  return {{"periods", std::move(periods)}, {"passes", std::move(passes)}};
}

} // namespace umov
