#include "inverse/quick_look.h"

#include "inverse/octahedron.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <umov/core/parallel.h>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {

QuickLook::QuickLook(const ObservedCurve &curve, const std::vector<std::size_t> &column,
                     std::size_t cells, std::size_t attitudes, unsigned threads)
    : curve_(curve), column_(column), attitudes_(attitude_grid(attitudes)) {
  constexpr std::size_t most = 8;            // epochs
  constexpr double off_i = 0.3, off_q = 0.05; // of the nearest node and the nearest attitude
  const std::size_t all = curve.epochs.size(), count = std::min(most, all);
  std::vector<std::size_t> slot(all, all);
  for (std::size_t k = 0; k < count; ++k) {
    epochs_.push_back(count < 2 ? 0 : k * (all - 1) / (count - 1));
    slot[epochs_.back()] = k;
  }
  for (const ObservedSample &s : curve.samples) {
    if (slot[s.epoch] == all || !(s.i > 0))
      continue;
    Row row{slot[s.epoch], column[s.band], static_cast<float>(std::log(s.i)), 0, 0, 0};
    row.weight_i = static_cast<float>(1 / (std::pow(s.i_sd / s.i, 2) + off_i * off_i));
    if (!std::isnan(s.q)) {
      row.q = static_cast<float>(s.q);
      row.weight_q = static_cast<float>(1 / (s.cov_qq + off_q * off_q));
    }
    rows_.push_back(row);
  }
  const DirectionGrid grid{cells};
  pair_.resize(attitudes_.size() * count);
  parallel_for(attitudes_.size(), threads, [&](std::size_t a) {
    for (std::size_t k = 0; k < count; ++k) {
      const Pose pose = pose_at({attitudes_[a], {}}, curve.epochs[epochs_[k]]);
      pair_[a * count + k] = static_cast<std::uint32_t>(
          pair_of(grid.nearest(pose.sun), grid.nearest(pose.observer), grid.nodes()));
    }
  });
}

float QuickLook::cost(const Signature &signature, std::size_t attitude,
                      std::vector<float> &ln_ratio) const {
  constexpr float most = 16; // what one number may cost: a glint between nodes vetoes nothing
  const auto step = static_cast<float>(signature.ln_step);
  const auto least = static_cast<float>(signature.ln_least);
  const float dark = least - 1;
  const std::uint32_t *const pair = &pair_[attitude * epochs_.size()];
  float sum = 0, weight = 1e-30f, out = 0;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const Row &row = rows_[r];
    const std::uint16_t *const at =
        &signature.code[(pair[row.epoch] * signature.bands + row.band) * 2];
    const float ln_i = at[0] == 0 ? dark : least + step * static_cast<float>(at[0] - 1);
    ln_ratio[r] = row.ln_i - ln_i;
    sum += row.weight_i * ln_ratio[r];
    weight += row.weight_i;
    const float dq = row.q - (static_cast<float>(at[1]) - 32768.f) * (1 / 32767.f);
    out += std::min(row.weight_q * dq * dq, most);
  }
  const float scale = sum / weight; // whatever the size and distance
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const float off = ln_ratio[r] - scale;
    out += std::min(rows_[r].weight_i * off * off, most);
  }
  return out;
}

std::vector<Turning> QuickLook::best(const Signature &signature, std::size_t count) const {
  std::vector<float> ln_ratio(rows_.size()), costs(attitudes_.size());
  for (std::size_t a = 0; a < costs.size(); ++a)
    costs[a] = cost(signature, a, ln_ratio);
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  count = std::min(count, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      return costs[a] < costs[b] || (costs[a] == costs[b] && a < b);
                    });
  std::vector<Turning> out;
  for (std::size_t k = 0; k < count; ++k)
    out.push_back({attitudes_[order[k]], {}});
  return out;
}

double QuickLook::score(const Signature &signature, const CurveErrors &errors) const {
  constexpr std::size_t starts = 24;
  constexpr int steps = 4;
  CurveErrors mild = errors;
  mild.floor = std::hypot(mild.floor, 0.05); // few steps do not reach the bottom
  mild.outlier_share = 0;
  const CurveLikelihood likelihood(curve_, mild, epochs_);
  const CurveModel model(curve_, lighting_of(signature, 1), column_);
  const auto fits = fit_turnings(model, likelihood, best(signature, starts), epochs_,
                                 {Freedom::Attitude, steps, 0, 0, 0.02, 1});
  double out = 1e300;
  for (const TurningFit &fit : fits)
    out = std::min(out, fit.at.minus_2_log);
  return out + likelihood.log_variance();
}

} // namespace umov::inverse
