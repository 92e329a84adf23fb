#include "light/reference/visibility_sampler.h"

#include "light/reference/visibility_points.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <umov/core/random.h>
#include <umov/core/stop.h>

namespace umov {
namespace {

/// Points traced together: enough for packets, little memory.
constexpr std::size_t batch_points = 8192;

/// Two-sided variance bookkeeping of one kind of result in one band.
struct Variance {
  double sum = 0, squares = 0; ///< of the variances of the cells
  double weight2 = 0;          ///< sum of the squared unhidden parts of the cells
  void add(double v) {
    sum += v;
    squares += v * v;
  }
  /// One more cell than was found is taken to disagree: slivers that no point met leave a
  /// half-width, and few disagreeing cells are not taken at their word (rule of succession).
  [[nodiscard]] double half_width(double cells) const {
    if (!(cells > 0))
      return 0;
    const double unseen = 0.25 * weight2 / cells;
    const double total = sum + unseen;
    const double all_squares = squares + unseen * unseen;
    if (!(all_squares > 0))
      return 0;
    // Welch & Satterthwaite (1946): one degree of freedom for each pair of points.
    return student_95(total * total / all_squares) * std::sqrt(total);
  }
};

class PointSampler {
public:
  PointSampler(const Scene &scene, const Elements &elements, const Occluder &occluder,
               const PoseGeometry &pose, const LitElements &lit, std::uint64_t seed,
               std::uint32_t stream, const std::atomic<bool> *cancel)
      : scene_(scene), elements_(elements), occluder_(occluder), pose_(pose), lit_(lit),
        seed_(seed), stream_(stream), bands_(scene.grid.nodes().size()), lobes_(lit.lobes),
        kinds_(lit.lobes + 1), variance_(bands_), block_specular_(lobes_), block_diffuse_(bands_),
        block_rule_(bands_), ratio_(kinds_), weight_sum_(kinds_), cancel_(cancel) {
    out_.sums.specular.assign(2 * scene.mesh.groups.size() * lobes_, 0);
    out_.sums.diffuse.resize(2 * scene.mesh.groups.size() * bands_);
    out_.sums.intensity.assign(bands_, 0);
    out_.sums.rule_variance.resize(bands_);
  }

  Measurement run(std::vector<Block> blocks) {
    out_.blocks = std::move(blocks);
    std::size_t first = 0;
    for (std::size_t i = 0; i < out_.blocks.size(); ++i) {
      draw(out_.blocks[i]);
      if (origins_.size() >= batch_points || i + 1 == out_.blocks.size()) {
        trace();
        std::size_t at = 0;
        for (; first <= i; ++first)
          at = finish(out_.blocks[first], at);
        out_.sums.points += origins_.size();
        origins_.clear();
        drawn_.clear();
      }
    }
    close();
    return std::move(out_);
  }

private:
  void draw(const Block &block) {
    for (std::size_t cell = 0; cell < block.cells(); ++cell) {
      leave_if_stopped(cancel_, cell);
      const auto u = uniform4(seed_, stream_, 2 * pair_);
      const auto choice = uniform4(seed_, stream_, 2 * pair_ + 1);
      ++pair_;
      for (std::size_t k = 0; k < 2; ++k) {
        const LitElement &lit = lit_.list[pick(block, choice[k])];
        const auto point =
            point_in_cell(std::max<std::size_t>(1, block.cuts), cell, u[2 * k], u[2 * k + 1]);
        origins_.push_back(
            ray_origin(scene_, elements_, lit, element_of(elements_, lit_, lit), point));
        drawn_.push_back({static_cast<std::uint32_t>(&lit - lit_.list.data()), point});
      }
    }
  }

  [[nodiscard]] std::size_t pick(const Block &block, double choice) const {
    if (block.last - block.first == 1)
      return block.first;
    double total = 0;
    for (std::size_t i = block.first; i < block.last; ++i)
      total += lit_.list[i].share;
    double below = choice * total;
    for (std::size_t i = block.first; i + 1 < block.last; ++i) {
      below -= lit_.list[i].share;
      if (below < 0)
        return i;
    }
    return block.last - 1;
  }

  /// Weights of a block's points in its integrals: each lobe's, then that of diffuse light.
  void weigh_block(std::size_t at, std::size_t count) {
    weights_.clear();
    for (std::size_t i = at; i < at + count; ++i) {
      leave_if_stopped(cancel_, i);
      weigh(lit_.list[drawn_[i].lit], drawn_[i].point);
    }
  }

  void weigh(const LitElement &lit, std::array<double, 2> p) {
    const Element &e = element_of(elements_, lit_, lit);
    if (e.is_flat) {
      for (std::size_t k = 0; k < lobes_; ++k)
        weights_.push_back(lit_.specular[lit.specular_at + k] / lit.share);
      weights_.push_back(lit.projected / lit.share);
      return;
    }
    const Vec3<Body> n = shading_normal(e, 1 - p[0] - p[1], p[0], p[1]);
    const Surface &surface = surface_of_slot(scene_, lit.slot);
    SurfaceDirections at =
        directions_at(scene_, pose_, e, lit.slot, static_cast<double>(lit.side) * n);
    if (!(at.l.z > 0 && at.v.z > 0)) {
      weights_.insert(weights_.end(), kinds_, 0.0);
      return;
    }
    // Only the shape over one element counts here, and the disk does not change that of a wide
    // lobe.
    if (surface.width() > 10 * pose_.sun_radius_rad)
      at.disk_rad = 0;
    const double scale = e.area_m2 / lit.share;
    for (std::size_t k = 0; k < lobes_; ++k)
      weights_.push_back(scale * surface.specular(k, at));
    weights_.push_back(scale * at.l.z * at.v.z);
  }

  /// Which origins are free, some at a time: a large flat has millions.
  void test(std::span<const Vec3<Body>> origins, Vec3<Body> direction,
            std::span<unsigned char> free) const {
    for (std::size_t begin = 0; begin < origins.size(); begin += batch_points) {
      leave_if_stopped(cancel_);
      const std::size_t count = std::min(batch_points, origins.size() - begin);
      occluder_.is_free(origins.subspan(begin, count), direction, free.subspan(begin, count));
    }
  }

  /// free_[i]: both directions are free at the same point.
  void trace() {
    const std::size_t count = origins_.size();
    free_.assign(count, 0);
    test(origins_, pose_.sun, free_);
    lit_origins_.clear();
    for (std::size_t i = 0; i < count; ++i)
      if (free_[i] != 0)
        lit_origins_.push_back(origins_[i]);
    seen_.assign(lit_origins_.size(), 0);
    test(lit_origins_, pose_.observer, seen_);
    out_.sums.rays += count + lit_origins_.size();
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i)
      if (free_[i] != 0)
        free_[i] = seen_[at++];
  }

  std::size_t finish(Block &block, std::size_t at) {
    const std::size_t count = 2 * block.cells();
    const std::size_t slot = sum_block(block);
    double seen = 0;
    for (std::size_t i = at; i < at + count; ++i)
      seen += free_[i] != 0 ? 1 : 0;
    const bool is_mixed = seen > 0 && seen < static_cast<double>(count);
    if (is_mixed)
      learn_ratios(at, count, seen);
    else // all or nothing, whatever the weights
      std::fill(ratio_.begin(), ratio_.end(), seen > 0 ? 1.0 : 0.0);
    out_.sums.is_any_seen = out_.sums.is_any_seen || seen > 0;
    for (std::size_t k = 0; k < lobes_; ++k)
      out_.sums.specular[slot * lobes_ + k] += ratio_[k] * block_specular_[k];
    out_.sums.glint += ratio_[0] * block_glint_;
    const double cells = static_cast<double>(block.cells());
    for (std::size_t b = 0; b < bands_; ++b) {
      const std::size_t lobe = lit_.lobe_of(b);
      out_.sums.diffuse[slot * bands_ + b] += block_diffuse_[b] * ratio_[lobes_];
      const Stokes<ScatteringPlane> f = lit_.fresnel[slot * bands_ + b];
      const Stokes<ScatteringPlane> all = f * block_specular_[lobe] + block_diffuse_[b];
      out_.sums.intensity[b] +=
          f.i * block_specular_[lobe] * ratio_[lobe] + block_diffuse_[b].i * ratio_[lobes_];
      const double seen_part = std::max(ratio_[lobe], ratio_[lobes_]);
      out_.sums.rule_variance[b] += block_rule_[b] * (seen_part * seen_part);
      const std::array<double, 4> parts{all.i, all.q, all.u, all.v};
      for (std::size_t k = 0; k < 4; ++k)
        variance_[b][k].weight2 += parts[k] * parts[k] / cells;
      if (lit_.total[b] > 0)
        block.weight2 +=
            all.i * all.i /
            (cells * cells * lit_.total[b] * lit_.total[b] * static_cast<double>(bands_));
    }
    cells_ += cells;
    if (is_mixed)
      add_variance(block, at, slot);
    return at + count;
  }

  /// Visible share of each kind of weight.
  void learn_ratios(std::size_t at, std::size_t count, double seen) {
    weigh_block(at, count);
    std::fill(ratio_.begin(), ratio_.end(), 0.0);
    std::fill(weight_sum_.begin(), weight_sum_.end(), 0.0);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < kinds_; ++k) {
        const double w = weights_[i * kinds_ + k];
        ratio_[k] += free_[at + i] != 0 ? w : 0;
        weight_sum_[k] += w;
      }
    for (std::size_t k = 0; k < kinds_; ++k)
      ratio_[k] =
          weight_sum_[k] > 0 ? ratio_[k] / weight_sum_[k] : seen / static_cast<double>(count);
  }

  /// Adds the light of the block's elements up; returns their common slot.
  std::size_t sum_block(const Block &block) {
    std::fill(block_specular_.begin(), block_specular_.end(), 0.0);
    std::fill(block_diffuse_.begin(), block_diffuse_.end(), Stokes<ScatteringPlane>{});
    std::fill(block_rule_.begin(), block_rule_.end(), Stokes<ScatteringPlane>{});
    block_glint_ = 0;
    const std::size_t slot = lit_.list[block.first].slot;
    for (std::size_t i = block.first; i < block.last; ++i) {
      const LitElement &lit = lit_.list[i];
      for (std::size_t k = 0; k < lobes_; ++k)
        block_specular_[k] += lit_.specular[lit.specular_at + k];
      if (lit.is_glint)
        block_glint_ += lit_.fresnel[slot * bands_].i * lit_.specular[lit.specular_at];
      for (std::size_t b = 0; b < bands_; ++b) {
        block_diffuse_[b] += lit_.diffuse[lit.diffuse_at + b];
        block_rule_[b] += lit_.rule_variance[lit.diffuse_at + b];
      }
    }
    return slot;
  }

  /// The ratio estimators' residuals of the two points of each cell.
  void add_variance(Block &block, std::size_t at, std::size_t slot) {
    std::vector<double> difference(kinds_);
    for (std::size_t i = 0; i < 2 * block.cells(); i += 2) {
      leave_if_stopped(cancel_, i);
      for (std::size_t k = 0; k < kinds_; ++k) {
        const auto residual = [&](std::size_t point) {
          const double v = free_[at + point] != 0 ? 1 : 0;
          return weight_sum_[k] > 0
                     ? weights_[point * kinds_ + k] * (v - ratio_[k]) / weight_sum_[k]
                     : 0.0;
        };
        difference[k] = residual(i) - residual(i + 1);
      }
      for (std::size_t b = 0; b < bands_; ++b) {
        const std::size_t lobe = lit_.lobe_of(b);
        const Stokes<ScatteringPlane> d =
            lit_.fresnel[slot * bands_ + b] * (block_specular_[lobe] * difference[lobe]) +
            block_diffuse_[b] * difference[lobes_];
        const std::array<double, 4> parts{d.i, d.q, d.u, d.v};
        for (std::size_t k = 0; k < 4; ++k)
          variance_[b][k].add(parts[k] * parts[k]);
        if (lit_.total[b] > 0)
          block.spread +=
              d.i * d.i /
              (lit_.total[b] * lit_.total[b] * static_cast<double>(bands_ * block.cells()));
      }
    }
  }

  void close() {
    for (const auto &band : variance_)
      out_.sums.half_width.push_back({band[0].half_width(cells_), band[1].half_width(cells_),
                                      band[2].half_width(cells_), band[3].half_width(cells_)});
  }

  const Scene &scene_;
  const Elements &elements_;
  const Occluder &occluder_;
  const PoseGeometry &pose_;
  const LitElements &lit_;
  std::uint64_t seed_;
  std::uint32_t stream_;
  std::size_t bands_, lobes_, kinds_; ///< kinds of weights: lobes, and diffuse light
  std::uint64_t pair_ = 0;
  double cells_ = 0;
  std::vector<std::array<Variance, 4>> variance_; ///< per band: I, Q, U, V
  std::vector<Vec3<Body>> origins_, lit_origins_;
  struct Drawn {
    std::uint32_t lit;
    std::array<double, 2> point;
  };
  std::vector<Drawn> drawn_;    ///< of the batch
  std::vector<double> weights_; ///< of one block: [point * kinds + kind]
  std::vector<unsigned char> free_, seen_;
  std::vector<double> block_specular_; ///< per lobe
  std::vector<Stokes<ScatteringPlane>> block_diffuse_, block_rule_;
  std::vector<double> ratio_, weight_sum_; ///< per kind: visible share, sum of weights
  double block_glint_ = 0;
  const std::atomic<bool> *cancel_;
  Measurement out_;
};

} // namespace

double student_95(double freedom) {
  constexpr double z = 1.959963984540054; // normal quantile at 0.975
  const double n = std::max(freedom, 1.0), z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  if (n < 3) // exact for 1, 2 and 3; between them linear in 1/n
    return n < 2 ? 4.302653 + (12.706205 - 4.302653) * (2 / n - 1)
                 : 3.182446 + (4.302653 - 3.182446) * (6 / n - 2);
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

std::vector<Block> make_blocks(const LitElements &lit, const std::vector<double> &cells) {
  std::vector<Block> out;
  std::size_t chain = 0; // first element of the open chain
  double filled = 0;
  const auto close_chain = [&](std::size_t end) {
    if (end > chain)
      out.push_back({chain, end, 0});
    chain = end;
    filled = 0;
  };
  for (std::size_t i = 0; i < lit.list.size(); ++i) {
    if (i > chain && lit.list[i].slot != lit.list[chain].slot)
      close_chain(i);
    if (cells[i] >= 1) {
      close_chain(i);
      const auto cuts = static_cast<std::size_t>(std::lround(std::sqrt(cells[i])));
      out.push_back({i, i + 1, std::max<std::size_t>(1, cuts)});
      chain = i + 1;
      continue;
    }
    filled += cells[i];
    if (filled >= 1)
      close_chain(i + 1);
  }
  close_chain(lit.list.size());
  return out;
}

Measurement measure(const Scene &scene, const Elements &elements, const Occluder &occluder,
                    const PoseGeometry &pose, const LitElements &lit, std::vector<Block> blocks,
                    std::uint64_t seed, std::uint32_t stream, const std::atomic<bool> *cancel) {
  return PointSampler(scene, elements, occluder, pose, lit, seed, stream, cancel)
      .run(std::move(blocks));
}

} // namespace umov
