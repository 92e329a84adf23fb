#include "instrument/pixel_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace umov {
namespace {

constexpr double far = 7.5; // standard deviations: 6e-14 of the numbers lie beyond

/// Poisson probabilities of [from, to].
std::vector<double> poisson_range(double mean, int from, int to) {
  std::vector<double> out;
  for (int n = from; n <= to; ++n)
    out.push_back(mean > 0 ? std::exp(n * std::log(mean) - mean - std::lgamma(n + 1.)) : 1);
  return out;
}

/// Adds the numbers that electrons read as: `centre` before rounding down.
void add_readings(std::vector<double> &out, int first, double centre, double sd, double weight) {
  const auto add = [&](double number, double share) {
    const auto at = static_cast<std::ptrdiff_t>(number) - first;
    if (at >= 0 && at < static_cast<std::ptrdiff_t>(out.size()))
      out[static_cast<std::size_t>(at)] += share;
  };
  if (!(sd > 0))
    return add(std::floor(centre), weight);
  const double from = std::floor(centre - far * sd), to = std::floor(centre + far * sd);
  const auto below = [&](double x) { return std::erfc((centre - x) / (sd * std::sqrt(2.))) / 2; };
  double under = below(from);
  for (double y = from; y <= to; ++y) {
    const double upper = below(y + 1);
    add(y, weight * (upper - under));
    under = upper;
  }
}

} // namespace

std::optional<PixelTable> PixelTable::make(const Detector &d, double mean) {
  constexpr double most = 4000; // beyond it a table costs more than it saves
  if (d.model == DetectorModel::Emccd || d.model == DetectorModel::Counter || !(mean >= 0) ||
      mean > most)
    return std::nullopt;
  const double spread = far * std::sqrt(mean) + far * far; // the tail of few electrons is long
  const int least = static_cast<int>(std::max(0., std::floor(mean - spread)));
  const int largest = mean > 0 ? static_cast<int>(std::ceil(mean + spread)) : 0;
  const double sd = has_converter(d) ? d.read_e / d.gain_e_adu : 0;
  const auto centre = [&](int n) { return number_of(d, n) + .5; };
  const double low = std::floor(centre(least) - far * sd) - 1;
  const double high = std::floor(centre(largest) + far * sd) + 1;
  const double last = std::min(last_adu(d), 2e9);
  constexpr double widest = 4096;
  const bool may_fill = has_converter(d) && d.well_e > 0 && largest > d.well_e;
  if (may_fill || low < (has_converter(d) ? 0 : -1) || high >= last || high - low >= widest)
    return std::nullopt;
  PixelTable out;
  out.first_ = static_cast<int>(low);
  std::vector<double> probability(static_cast<std::size_t>(high - low) + 1);
  const std::vector<double> poisson = poisson_range(mean, least, largest);
  for (int n = least; n <= largest; ++n)
    if (const double p = poisson[static_cast<std::size_t>(n - least)]; p > 1e-15)
      add_readings(probability, out.first_, centre(n), sd, p);
  out.fill(std::move(probability));
  return out;
}

void PixelTable::fill(std::vector<double> probability) {
  std::size_t columns = 2;
  for (shift_ = 31; columns < probability.size(); columns *= 2)
    --shift_;
  probability.resize(columns);
  const double sum = std::accumulate(probability.begin(), probability.end(), 0.);
  std::vector<std::size_t> small, large;
  for (std::size_t k = 0; k < columns; ++k) {
    probability[k] *= static_cast<double>(columns) / sum;
    (probability[k] < 1 ? small : large).push_back(k);
  }
  constexpr auto all = std::numeric_limits<std::uint32_t>::max();
  threshold_.assign(columns, all);
  alias_.resize(columns);
  std::iota(alias_.begin(), alias_.end(), 0u);
  while (!small.empty() && !large.empty()) {
    const std::size_t less = small.back(), more = large.back();
    small.pop_back();
    threshold_[less] =
        static_cast<std::uint32_t>(std::min(probability[less] * 4294967296., 4294967295.));
    alias_[less] = static_cast<std::uint32_t>(more);
    probability[more] -= 1 - probability[less];
    if (probability[more] < 1) {
      large.pop_back();
      small.push_back(more);
    }
  }
}

} // namespace umov
