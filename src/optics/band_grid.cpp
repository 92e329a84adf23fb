#include <umov/optics/band_grid.h>

#include "optics/band_points.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace umov {
namespace {

/// Multiples of a step within a curve, and its two ends: grids of all bands share their
/// wavelengths, and a grid of twice the step is a part of it.
std::vector<double> grid_of(const Passband &band, double step_nm) {
  const double first = band.wavelength_nm.front(), last = band.wavelength_nm.back();
  std::vector<double> out{first};
  for (double k = std::floor(first / step_nm) + 1; k * step_nm < last; ++k)
    out.push_back(k * step_nm);
  out.push_back(last);
  return out;
}

/// Detected sunlight that falls to each wavelength of a grid: hat functions (Eq. 6), sum 1.
Result<std::vector<double>> weights_of(const Passband &band, const std::vector<double> &grid) {
  UMOV_TRY(sunlight_in(band)); // covered, and not dark
  std::vector<double> out(grid.size(), 0);
  double sum = 0;
  std::size_t k = 0;
  for (const BandPoint &p : band_points(band, grid)) {
    while (k + 2 < grid.size() && p.wavelength_nm >= grid[k + 1])
      ++k;
    const double light = p.weight * value_at(sunlight(), p.wavelength_nm) * p.wavelength_nm;
    const double t = (p.wavelength_nm - grid[k]) / (grid[k + 1] - grid[k]);
    out[k] += (1 - t) * light;
    out[k + 1] += t * light;
    sum += light;
  }
  for (double &weight : out)
    weight /= sum;
  return out;
}

Result<void> check_width(const Passband &band) {
  constexpr double widest_nm = 10'000; // a grid of a thousand wavelengths
  const double first = band.wavelength_nm.front(), last = band.wavelength_nm.back();
  if (last - first <= widest_nm)
    return {};
  return fail(ErrorCode::BadInput,
              fmt::format("band \"{}\" is {:g}-{:g} nm wide; at most {:g} nm are summed over. Cut "
                          "the curve where its response no longer matters.",
                          band.name, first, last, widest_nm));
}

} // namespace

Result<BandGrid> BandGrid::make(const std::vector<Band> &bands,
                                const std::vector<double> &steps_nm) {
  BandGrid out;
  std::map<double, std::size_t> known;
  const auto node = [&](double nm, const Band &band) {
    const auto [at, is_new] = known.try_emplace(nm, out.nodes_.size());
    if (is_new)
      out.nodes_.push_back({band.name, Wavelength::nm(nm), band.curve});
    return at->second;
  };
  for (std::size_t b = 0; b < bands.size(); ++b) {
    std::vector<BandTerm> &terms = out.terms_.emplace_back();
    if (!bands[b].curve) {
      terms.push_back({out.nodes_.size(), 1, 1});
      out.nodes_.push_back(bands[b]);
      continue;
    }
    out.is_plain_ = false;
    const double step = steps_nm.empty() ? node_step_nm : steps_nm[b];
    UMOV_TRY(check_width(*bands[b].curve));
    const std::vector<double> fine = grid_of(*bands[b].curve, step),
                              coarse = grid_of(*bands[b].curve, 2 * step);
    UMOV_ASSIGN(weights, weights_of(*bands[b].curve, fine));
    UMOV_ASSIGN(coarse_weights, weights_of(*bands[b].curve, coarse));
    if (b == 0) {
      const auto heaviest = std::max_element(weights.begin(), weights.end()) - weights.begin();
      node(fine[static_cast<std::size_t>(heaviest)], bands[b]);
    }
    std::size_t next = 0;
    for (std::size_t k = 0; k < fine.size(); ++k) {
      const bool is_coarse = next < coarse.size() && coarse[next] == fine[k];
      terms.push_back({node(fine[k], bands[b]), weights[k], is_coarse ? coarse_weights[next] : 0});
      next += is_coarse ? 1u : 0u;
    }
  }
  return out;
}

} // namespace umov
