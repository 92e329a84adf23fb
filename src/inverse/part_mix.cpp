#include "inverse/part_mix.h"

#include <algorithm>
#include <cmath>

namespace umov::inverse {
namespace {

constexpr double dark = 1e-6; // of all light: whatever it becomes is not seen

} // namespace

PartMix::PartMix(const ModelLight &model)
    : model_(model), cells_(model.i.size()), i_(model.i.begin(), model.i.end()),
      q_(model.q.begin(), model.q.end()), u_(model.u.begin(), model.u.end()) {
  for (std::size_t k = 0; k < cells_; ++k)
    if (model.i[k] > 0)
      lit_.push_back(k);
  factor_.assign(model.parts.size() * cells_, 1);
  name_unknowns();
  bend_.assign(first_.size(), 0);
}

void PartMix::name_unknowns() {
  const std::size_t parts = model_.parts.size();
  for (std::size_t p = 0; p < parts; ++p)
    if (model_.parts[p].sd > 0)
      unknowns_.push_back({p});
  for (std::size_t p = 0; p < parts; ++p)
    if (!model_.parts[p].smooth.empty()) {
      unknowns_.push_back({p, bent_.size(), 1});
      put_slopes(p);
    }
  for (std::size_t p = 0; p < parts; ++p) {
    if (p > 0 && model_.parts[p].tilts_with_last)
      continue;
    std::size_t behind = p + 1; // surfaces that are turned together
    while (behind < parts && model_.parts[behind].tilts_with_last &&
           !model_.parts[behind].tilted[0].empty())
      ++behind;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (model_.parts[p].tilted[axis].empty())
        continue;
      unknowns_.push_back({p, bent_.size(), behind - p});
      for (std::size_t one = p; one < behind; ++one)
        put_tilt(one, axis);
    }
  }
}

/// Its first place in what is told of bends.
std::size_t PartMix::add_bend(std::size_t part) {
  const std::size_t begin = first_.size();
  bent_.push_back(part);
  first_.resize(bent_.size() * cells_, 0);
  second_.resize(bent_.size() * cells_, 0);
  return begin;
}

/// Far from a lobe's middle its light goes with a power of e of the slope, and near it nearly so.
void PartMix::put_slopes(std::size_t part) {
  const std::size_t begin = add_bend(part);
  const PartLight &own = model_.parts[part];
  for (const std::size_t k : lit_) {
    const double least = dark * model_.i[k];
    if (!(std::max({own.i[k], own.smooth[k], own.rough[k]}) > least))
      continue;
    const double less = std::log((own.smooth[k] + least) / (own.i[k] + least));
    const double more = std::log((own.rough[k] + least) / (own.i[k] + least));
    first_[begin + k] = (more - less) / 2;
    second_[begin + k] = (more + less) / 2;
  }
}

/// With a turn it goes as its first derivative says, which a short step tells: at the peak of a
/// lobe that is next to nothing. Where a step puts light out, its ln falls without end: what a
/// whole turn may do is bounded, or a small turn the other way would make any light of it.
void PartMix::put_tilt(std::size_t part, std::size_t axis) {
  const std::size_t begin = add_bend(part);
  constexpr double most = 2; // e-folds: of a lobe half a degree wide, two widths off, turned by .5
  const PartLight &own = model_.parts[part];
  for (const std::size_t k : lit_) {
    const double least = dark * model_.i[k], tilted = own.tilted[axis][k];
    if (std::max(own.i[k], tilted) > least)
      first_[begin + k] =
          std::clamp(std::log((tilted + least) / (own.i[k] + least)) / tilt_step, -most, most);
  }
}

void PartMix::set(std::span<const double> off) {
  constexpr double most = 5; // e-folds: beyond, light nearby says nothing
  const std::size_t parts = model_.parts.size();
  power_.assign(parts * cells_, 0);
  std::vector<double> amount(parts, 1);
  for (std::size_t n = 0; n < unknowns_.size(); ++n) {
    const auto [part, first, bends] = unknowns_[n];
    const double y = off[n];
    if (bends == 0)
      amount[part] = std::exp(model_.parts[part].sd * y);
    for (std::size_t b = first; b < first + bends; ++b)
      for (const std::size_t k : lit_) {
        const std::size_t at = b * cells_ + k;
        power_[bent_[b] * cells_ + k] += y * (first_[at] + y * second_[at]);
        bend_[at] = first_[at] + 2 * y * second_[at];
      }
  }
  for (std::size_t b = 0; b < bent_.size(); ++b)
    for (const std::size_t k : lit_)
      if (!(std::abs(power_[bent_[b] * cells_ + k]) < most))
        bend_[b * cells_ + k] = 0;
  std::ranges::copy(model_.i, i_.begin());
  std::ranges::copy(model_.q, q_.begin());
  std::ranges::copy(model_.u, u_.begin());
  for (std::size_t p = 0; p < parts; ++p) {
    const PartLight &part = model_.parts[p];
    for (const std::size_t k : lit_) {
      const double power = power_[p * cells_ + k];
      double &factor = factor_[p * cells_ + k];
      factor = amount[p] * (power == 0 ? 1 : std::exp(std::clamp(power, -most, most)));
      const double more = factor - 1;
      i_[k] += more * part.i[k];
      q_[k] += more * part.q[k];
      u_[k] += more * part.u[k];
    }
  }
}

} // namespace umov::inverse
