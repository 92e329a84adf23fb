#include "inverse/part_mix.h"

#include <algorithm>
#include <cmath>

namespace umov::inverse {

PartMix::PartMix(const ModelLight &model)
    : model_(model), cells_(model.i.size()), i_(model.i.begin(), model.i.end()),
      q_(model.q.begin(), model.q.end()), u_(model.u.begin(), model.u.end()) {
  for (std::size_t p = 0; p < model.parts.size(); ++p)
    if (model.parts[p].sd > 0)
      unknowns_.push_back({p, false});
  for (std::size_t p = 0; p < model.parts.size(); ++p)
    if (!model.parts[p].smooth.empty())
      unknowns_.push_back({p, true});
  for (std::size_t k = 0; k < cells_; ++k)
    if (model.i[k] > 0)
      lit_.push_back(k);
  put_slopes();
}

/// Far from a lobe's middle its light goes with a power of e of the slope, and near it nearly so.
void PartMix::put_slopes() {
  const std::size_t size = model_.parts.size() * cells_;
  first_.assign(size, 0);
  second_.assign(size, 0);
  factor_.assign(size, 1);
  by_slope_.assign(size, 0);
  for (const Unknown &unknown : unknowns_) {
    const PartLight &part = model_.parts[unknown.part];
    if (!unknown.is_slope)
      continue;
    for (const std::size_t k : lit_) {
      constexpr double dark = 1e-6; // of all light: whatever it becomes is not seen
      const double least = dark * model_.i[k];
      if (!(std::max({part.i[k], part.smooth[k], part.rough[k]}) > least))
        continue;
      const double less = std::log((part.smooth[k] + least) / (part.i[k] + least));
      const double more = std::log((part.rough[k] + least) / (part.i[k] + least));
      first_[unknown.part * cells_ + k] = (more - less) / 2;
      second_[unknown.part * cells_ + k] = (more + less) / 2;
    }
  }
}

void PartMix::set(std::span<const double> off) {
  const std::size_t parts = model_.parts.size();
  std::vector<double> amount(parts, 1), slope(parts, 0);
  for (std::size_t k = 0; k < unknowns_.size(); ++k) {
    const std::size_t p = unknowns_[k].part;
    (unknowns_[k].is_slope ? slope[p] : amount[p]) =
        unknowns_[k].is_slope ? off[k] : std::exp(model_.parts[p].sd * off[k]);
  }
  std::ranges::copy(model_.i, i_.begin());
  std::ranges::copy(model_.q, q_.begin());
  std::ranges::copy(model_.u, u_.begin());
  constexpr double most = 5; // e-folds: beyond, three roughnesses say nothing
  for (std::size_t p = 0; p < parts; ++p) {
    const PartLight &part = model_.parts[p];
    for (const std::size_t k : lit_) {
      const std::size_t at = p * cells_ + k;
      const double y = slope[p], power = y * (first_[at] + y * second_[at]);
      by_slope_[at] = std::abs(power) < most ? first_[at] + 2 * y * second_[at] : 0;
      factor_[at] = amount[p] * (power == 0 ? 1 : std::exp(std::clamp(power, -most, most)));
      const double more = factor_[at] - 1;
      i_[k] += more * part.i[k];
      q_[k] += more * part.q[k];
      u_[k] += more * part.u[k];
    }
  }
}

} // namespace umov::inverse
