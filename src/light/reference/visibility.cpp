#include "light/reference/visibility.h"

#include "light/reference/visibility_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace umov {
namespace {

/// Cells of the first look, which only tells where the points of the next set belong.
constexpr double pilot_cells = 1024;
/// Points are set out for this part of the wanted half-width, so that one set mostly suffices.
constexpr double margin = 0.8;
constexpr int rounds_max = 8;
/// Most that one look may multiply the cells of a place: its variance is itself uncertain.
constexpr double growth_max = 1024;
/// Variance of a cell whose points agree, as part of that of one whose points differ.
constexpr double agreeing_variance = 0.01;
/// A cell that an edge crosses varies like its weight squared, and the number of such cells like
/// the root of all: the variance of a place falls with the 3/2 power of its cells.
constexpr double decay = 1.5;

/// What a relative error of a band refers to: I, or the floor below which it need not be known as
/// well.
double reference(const IntegrationOptions &options, const VisibleSums &sums, std::size_t band) {
  return std::max(sums.intensity[band], options.floor_i.empty() ? 0 : options.floor_i[band]);
}

/// Largest half-width of I relative to that over the bands; infinite if nothing is seen.
double worst_relative(const IntegrationOptions &options, const VisibleSums &sums) {
  double worst = 0;
  for (std::size_t b = 0; b < sums.intensity.size(); ++b) {
    if (sums.half_width[b].i <= 0)
      continue;
    const double refers_to = reference(options, sums, b);
    worst = std::max(worst, refers_to > 0 ? sums.half_width[b].i / refers_to
                                          : std::numeric_limits<double>::infinity());
  }
  return worst;
}

/// Variance per cell of each block, evened out over neighbours: two points know little of it.
std::vector<double> smooth_spread(const std::vector<Block> &blocks) {
  constexpr std::size_t reach = 4;
  constexpr std::size_t own_is_enough = 16; // cells
  std::vector<double> out(blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const std::size_t begin = i > reach ? i - reach : 0;
    const std::size_t end = std::min(blocks.size(), i + reach + 1);
    double spread = 0, cells = 0;
    for (std::size_t j = begin; j < end; ++j) {
      if (j != i && (blocks[j].cells() >= own_is_enough || blocks[i].cells() >= own_is_enough))
        continue;
      const double n = static_cast<double>(blocks[j].cells());
      spread += n * blocks[j].spread;
      cells += n;
    }
    out[i] = spread / cells + agreeing_variance * 0.25 * blocks[i].weight2;
  }
  return out;
}

struct Growth {
  std::vector<double> factor; ///< per block
  double cells = 0;           ///< in all
  bool is_enough = false;     ///< for the wanted variance, as far as one can tell
};

/// Fewest cells for a wanted total variance (Neyman 1934, with the decay above): growth goes with
/// the 1 / (1 + decay) power of the variance per cell.
Growth grow_to(const std::vector<Block> &blocks, const std::vector<double> &spread,
               double wanted_variance, double at_least, double cells_max) {
  Growth out;
  out.factor.resize(blocks.size());
  const auto apply = [&](double scale) {
    double variance = 0;
    out.cells = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const double n = static_cast<double>(blocks[i].cells());
      out.factor[i] =
          std::clamp(scale * std::pow(spread[i], 1 / (1 + decay)), at_least, growth_max);
      variance += n * spread[i] * std::pow(out.factor[i], -decay);
      out.cells += n * out.factor[i];
    }
    return variance;
  };
  double low = 1e-6, high = 1e12;
  for (int k = 0; k < 80; ++k) {
    const double middle = std::sqrt(low * high);
    const bool is_enough = apply(middle) <= wanted_variance;
    (is_enough || out.cells > cells_max ? high : low) = middle;
  }
  out.is_enough = apply(high) <= wanted_variance * 1.01;
  return out;
}

class Refiner {
public:
  Refiner(const Scene &scene, const Elements &elements, const Occluder &occluder,
          const PoseGeometry &pose, const LitElements &lit, const IntegrationOptions &options,
          const std::atomic<bool> *cancel)
      : scene_(scene), elements_(elements), occluder_(occluder), pose_(pose), lit_(lit),
        options_(options), cancel_(cancel) {}

  VisibleSums run() {
    for (const LitElement &lit : lit_.list)
      cells_.push_back(pilot_cells * lit.share);
    Measurement last = look(1);
    // NOTE: every set is drawn afresh. Keeping points whose agreement decided that no more were
    // needed would bias the variance low (optional stopping).
    for (int round = 0; round < rounds_max; ++round) {
      const double cells_before = static_cast<double>(last.sums.points) / 2;
      if (!refine(last, round == 0 ? 2 : 1, round > 1))
        break;
      last = look(1);
      const bool is_spent =
          static_cast<double>(last.sums.points) * 1.5 > static_cast<double>(options_.max_points);
      const bool is_stuck = static_cast<double>(last.sums.points) / 2 <= cells_before * 1.01;
      if (worst_relative(options_, last.sums) <= options_.accuracy || is_spent || is_stuck)
        break;
    }
    if (options_.density != 1)
      last = look(options_.density);
    last.sums.rays = rays_;
    return std::move(last.sums);
  }

private:
  Measurement look(double density) {
    std::vector<double> cells = cells_;
    for (double &c : cells)
      c *= density;
    Measurement out = measure(scene_, elements_, occluder_, pose_, lit_, make_blocks(lit_, cells),
                              options_.seed, stream_++, cancel_);
    rays_ += out.sums.rays;
    return out;
  }

  /// Sets the cells of the next look; false if there is no room for more points, or not for enough.
  bool refine(const Measurement &last, double at_least, bool must_suffice) {
    // Least part of the unhidden light that is seen, over the bands: what the accuracy refers to.
    double visible = options_.floor_i.empty() ? 1 : std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; b < lit_.total.size(); ++b)
      if (lit_.total[b] > 0)
        visible = std::min(visible, reference(options_, last.sums, b) / lit_.total[b]);
    constexpr double dark = 0.02; // a dark pose is looked at as if this part of it were seen
    const double wanted = margin * options_.accuracy * std::max(visible, dark) / student_95(30);
    const double room = static_cast<double>(options_.max_points) / 2;
    const auto spread = smooth_spread(last.blocks);
    const Growth growth = grow_to(last.blocks, spread, wanted * wanted, at_least, room);
    // Out of reach: more points would cost much and change little.
    if (growth.cells > 1.5 * room || (must_suffice && !growth.is_enough))
      return false;
    for (std::size_t i = 0; i < last.blocks.size(); ++i)
      for (std::size_t e = last.blocks[i].first; e < last.blocks[i].last; ++e)
        cells_[e] =
            growth.factor[i] *
            (last.blocks[i].cuts > 0 ? static_cast<double>(last.blocks[i].cells()) : cells_[e]);
    return true;
  }

  const Scene &scene_;
  const Elements &elements_;
  const Occluder &occluder_;
  const PoseGeometry &pose_;
  const LitElements &lit_;
  const IntegrationOptions &options_;
  const std::atomic<bool> *cancel_;
  std::vector<double> cells_; ///< wanted per lit element
  std::uint32_t stream_ = 0;
  std::uint64_t rays_ = 0;
};

} // namespace

VisibleSums sum_unhidden(const Scene &scene, const LitElements &lit) {
  const std::size_t bands = scene.grid.nodes().size(), slots = 2 * scene.mesh.groups.size();
  VisibleSums out;
  out.specular.assign(slots * lit.lobes, 0);
  out.diffuse.resize(slots * bands);
  out.rule_variance.resize(bands);
  for (const LitElement &e : lit.list) {
    for (std::size_t k = 0; k < lit.lobes; ++k)
      out.specular[e.slot * lit.lobes + k] += lit.specular[e.specular_at + k];
    if (e.is_glint)
      out.glint += lit.fresnel[e.slot * bands].i * lit.specular[e.specular_at];
    for (std::size_t b = 0; b < bands; ++b) {
      out.diffuse[e.slot * bands + b] += lit.diffuse[e.diffuse_at + b];
      out.rule_variance[b] += lit.rule_variance[e.diffuse_at + b];
    }
  }
  out.intensity = lit.total;
  out.half_width.resize(bands);
  out.is_any_seen = !lit.list.empty();
  return out;
}

VisibleSums sum_visible(const Scene &scene, const Elements &elements, const Occluder &occluder,
                        const PoseGeometry &pose, const LitElements &lit,
                        const IntegrationOptions &options, const std::atomic<bool> *cancel) {
  if (lit.list.empty())
    return sum_unhidden(scene, lit);
  return Refiner(scene, elements, occluder, pose, lit, options, cancel).run();
}

} // namespace umov
