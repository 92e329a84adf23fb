#include "inverse/quick_look.h"

#include "inverse/light_codes.h"
#include "inverse/octahedron.h"
#include "inverse/some_epochs.h"
#include <umov/inverse/sample_errors.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {
namespace {

/// The nearest node is up to 4.5 deg off, and the nearest attitude as far again.
CurveErrors rough(CurveErrors errors) {
  errors.floor_median = std::hypot(errors.of_median(), 0.15);
  errors.floor = std::hypot(errors.floor, 0.35);
  errors.floor_q = 0.06;
  errors.outlier_share = 0;
  return errors;
}

} // namespace

QuickLook::QuickLook(const ObservedCurve &curve, const CurveErrors &errors, std::size_t grid,
                     std::size_t epochs)
    : curve_(curve), grid_(attitude_grid(grid)), slots_(some_epochs(curve.epochs.size(), epochs)) {
  const CurveErrors taken = rough(errors);
  const double median = median_of_i(curve);
  for (const ObservedSample &s : curve.samples) {
    const auto slot = std::ranges::find(slots_, s.epoch);
    if (slot == slots_.end())
      continue;
    const SampleErrors known = errors_of(s, taken, median);
    Row row;
    row.slot = static_cast<std::uint32_t>(slot - slots_.begin());
    row.band = static_cast<std::uint32_t>(s.band);
    if (known.i_variance > 0) {
      row.i = static_cast<float>(s.i);
      row.weight = static_cast<float>(1 / known.i_variance);
      data_ += s.i * s.i / known.i_variance;
    }
    if (known.l_qq > 0) {
      row.q_code = static_cast<float>(LightCodes::code_of_q(s.q));
      const double weight = known.l_qq / LightCodes::half;
      row.q_weight = static_cast<float>(weight * weight);
    }
    if (row.weight > 0 || row.q_weight > 0)
      rows_.push_back(row);
  }
}

std::shared_ptr<const std::vector<std::uint32_t>> QuickLook::pairs_for(std::size_t cells) const {
  const std::scoped_lock hold(lock_);
  auto &kept = pairs_[cells];
  if (kept)
    return kept;
  const DirectionGrid nodes{cells};
  auto made = std::make_shared<std::vector<std::uint32_t>>();
  made->reserve(poses() + attitudes_at_once * slots_.size());
  for (const Quaternion &q : grid_) {
    for (const std::size_t epoch : slots_) {
      const Pose pose = pose_at({q, {}}, curve_.epochs[epoch]);
      made->push_back(static_cast<std::uint32_t>(
          pair_of(nodes.nearest(pose.sun), nodes.nearest(pose.observer), nodes.nodes())));
    }
  }
  made->resize(made->size() + attitudes_at_once * slots_.size()); // all are asked by so many
  kept = std::move(made);
  return kept;
}

std::vector<float> QuickLook::look(const Signature &signature,
                                   std::span<const std::size_t> column) const {
  const LightCodes codes(signature);
  const auto pairs = pairs_for(signature.cells);
  std::vector<Row> rows = rows_;
  for (Row &row : rows)
    row.band = static_cast<std::uint32_t>(2 * column[row.band]);
  std::vector<float> out(grid_.size() + attitudes_at_once);
  for (std::size_t k = 0; k < grid_.size(); k += attitudes_at_once)
    look_at(signature, codes, rows, pairs->data() + k * slots_.size(), &out[k]);
  out.resize(grid_.size());
  return out;
}

/// Attitudes whose sums do not wait for each other.
void QuickLook::look_at(const Signature &signature, const LightCodes &codes,
                        std::span<const Row> rows, const std::uint32_t *pairs, float *out) const {
  constexpr std::size_t n = attitudes_at_once;
  const std::size_t per = signature.bands * 2, slots = slots_.size();
  const std::uint16_t *const code = signature.code.data();
  float cross[n] = {}, square[n] = {}, chi2[n] = {};
  for (const Row &row : rows) {
    float m[n], q[n];
    for (std::size_t j = 0; j < n; ++j) {
      const std::uint16_t *const light = code + pairs[j * slots + row.slot] * per + row.band;
      m[j] = codes.i_or_dark(light[0]);
      q[j] = light[1];
    }
    for (std::size_t j = 0; j < n; ++j) {
      const float weighed = row.weight * m[j], dq = row.q_code - q[j];
      cross[j] += weighed * row.i;
      square[j] += weighed * m[j];
      chi2[j] += row.q_weight * dq * dq;
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    // The best scale, which is not negative.
    const float gain = square[j] > 0 && cross[j] > 0 ? cross[j] * cross[j] / square[j] : 0;
    out[j] = chi2[j] + static_cast<float>(data_) - gain;
  }
}

double QuickLook::log_evidence(const std::vector<float> &chi2) {
  const auto least = static_cast<double>(*std::ranges::min_element(chi2));
  double sum = 0;
  for (const float c : chi2)
    sum += std::exp(-(static_cast<double>(c) - least) / 2);
  return -least / 2 + std::log(sum / static_cast<double>(chi2.size()));
}

std::vector<std::size_t> QuickLook::best(const std::vector<float> &chi2, std::size_t count) {
  std::vector<std::size_t> out(chi2.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  count = std::min(count, out.size());
  std::partial_sort(
      out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count), out.end(),
      [&](std::size_t a, std::size_t b) { return chi2[a] != chi2[b] ? chi2[a] < chi2[b] : a < b; });
  out.resize(count);
  return out;
}

} // namespace umov::inverse
