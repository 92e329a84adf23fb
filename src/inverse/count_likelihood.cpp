#include "inverse/count_likelihood.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace umov::inverse {
namespace {

constexpr std::size_t most = 8; // channels at once; of more, the rest is a set of its own
constexpr double least_electrons = 1e-3;

/// Electrons of one channel per unit of the scale.
template <class Light>
double light_of(const ObservedCount &count, const Light &model, std::size_t at) {
  return count.by_i * model.i[at] + count.by_q * model.q[at] + count.by_u * model.u[at];
}

} // namespace

CountLikelihood::CountLikelihood(const ObservedCurve &curve, const CurveErrors &errors,
                                 double median_i, std::span<const std::size_t> epochs)
    : errors_(errors), median_i_(median_i) {
  for (const ObservedCount &count : curve.counts) {
    if (!epochs.empty() && std::ranges::find(epochs, count.epoch) == epochs.end())
      continue;
    const std::size_t at = count.epoch * curve.bands.size() + count.band;
    if (sets_.empty() || sets_.back().at != at || sets_.back().size == most)
      sets_.push_back({at, errors.has_clouds ? count.epoch : count.band, counts_.size(), 0});
    ++sets_.back().size;
    counts_.push_back(count);
  }
}

double CountLikelihood::first_scale(const ModelLight &model) const {
  double cross = 0, square = 0;
  for (const Set &set : sets_)
    for (std::size_t k = set.begin; k < set.begin + set.size; ++k) {
      const ObservedCount &count = counts_[k];
      const double light = light_of(count, model, set.at);
      const double noise =
          std::max(count.net + count.sky, 1.0) * count.excess2 + count.fixed_variance;
      const double of_model = errors_.floor * count.net;
      const double weight = 1 / (noise + of_model * of_model);
      cross += weight * count.net * light;
      square += weight * light * light;
    }
  return square > 0 ? std::max(cross / square, 0.0) : 0;
}

WhitenedCounts CountLikelihood::whitened(const ModelLight &model, double scale) const {
  WhitenedCounts out;
  out.net.resize(counts_.size());
  out.light.resize(counts_.size());
  out.parts.assign(model.parts.size(), std::vector<double>(counts_.size()));
  algebra::Whitener whitener;
  for (const Set &set : sets_)
    whiten_set(set, model, scale, whitener, out);
  return out;
}

/// C = noise of the model's own counts + what moves the channels together: transparency and the
/// model's error in I, its errors in q and u, its numerical error.
void CountLikelihood::whiten_set(const Set &set, const ModelLight &model, double scale,
                                 algebra::Whitener &whitener, WhitenedCounts &out) const {
  constexpr std::size_t terms = 5;
  constexpr double half_width = 1.96;
  const double clouds = errors_.has_clouds ? errors_.zero_point_sd : 0;
  const double floor = std::max(errors_.floor, best_relative);
  const double of_q = std::max(errors_.of_q(), best_relative);
  const double in_i = scale * model.i[set.at];
  const double width =
      model.i_half_width.empty() ? 0 : scale * model.i_half_width[set.at] / half_width;
  std::array<double, terms * most> common{};
  std::array<double, most> variance{};
  for (std::size_t a = 0; a < set.size; ++a) {
    const ObservedCount &count = counts_[set.begin + a];
    const double light = light_of(count, model, set.at), mean = scale * light;
    const double flicker = count.has_own_pupil ? 0 : count.scintillation;
    const double effects[terms] = {
        mean * std::sqrt(floor * floor + clouds * clouds + flicker * flicker),
        count.by_q * in_i * of_q, count.by_u * in_i * of_q,
        count.by_i * errors_.of_median() * median_i_, count.by_i * width};
    std::ranges::copy(effects, common.begin() + static_cast<std::ptrdiff_t>(a * terms));
    variance[a] =
        count.excess2 * std::max(mean + count.sky, least_electrons) + count.fixed_variance;
    if (count.has_own_pupil)
      variance[a] += std::pow(mean * count.scintillation, 2);
    out.net[set.begin + a] = count.net;
    out.light[set.begin + a] = light;
    for (std::size_t p = 0; p < out.parts.size(); ++p)
      out.parts[p][set.begin + a] = light_of(count, model.parts[p], set.at);
  }
  whitener.reset(std::span(variance).first(set.size), std::span(common).first(set.size * terms),
                 terms);
  out.log_det += whitener.log_determinant();
  const auto whiten = [&](std::vector<double> &side) {
    whitener.whiten(std::span(side).subspan(set.begin, set.size));
  };
  whiten(out.net);
  whiten(out.light);
  for (std::vector<double> &part : out.parts)
    whiten(part);
}

} // namespace umov::inverse
