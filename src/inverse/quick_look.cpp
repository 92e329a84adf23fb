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
      row.q = static_cast<float>(s.q);
      row.q_weight = static_cast<float>(known.l_qq * known.l_qq);
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
  made->reserve(poses());
  for (const Quaternion &q : grid_) {
    for (const std::size_t epoch : slots_) {
      const Pose pose = pose_at({q, {}}, curve_.epochs[epoch]);
      made->push_back(static_cast<std::uint32_t>(
          pair_of(nodes.nearest(pose.sun), nodes.nearest(pose.observer), nodes.nodes())));
    }
  }
  kept = std::move(made);
  return kept;
}

std::vector<float> QuickLook::look(const Signature &signature,
                                   std::span<const std::size_t> column) const {
  const LightCodes codes(signature);
  const auto pairs = pairs_for(signature.cells);
  const std::size_t per = signature.bands * 2;
  std::vector<float> out(grid_.size());
  for (std::size_t k = 0; k < grid_.size(); ++k) {
    const std::uint32_t *const at = pairs->data() + k * slots_.size();
    float cross = 0, square = 0, chi2 = 0;
    for (const Row &row : rows_) {
      const std::uint16_t *const light = &signature.code[at[row.slot] * per + 2 * column[row.band]];
      const float m = codes.i(light[0]);
      cross += row.weight * row.i * m;
      square += row.weight * m * m;
      const float dq = row.q - static_cast<float>(LightCodes::q(light[1]));
      chi2 += row.q_weight * dq * dq;
    }
    // The best scale, which is not negative.
    const float gain = square > 0 && cross > 0 ? cross * cross / square : 0;
    out[k] = chi2 + static_cast<float>(data_) - gain;
  }
  return out;
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
