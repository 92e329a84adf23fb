#include <umov/inverse/direction_table.h>

#include "inverse/octahedron.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <umov/core/parallel.h>

namespace umov {
using inverse::DirectionGrid;

namespace {

constexpr std::size_t lanes = 4; // numbers that a processor multiplies at once, whichever it is

/// Sums of `width` numbers each of the sixteen pairs about a pose, by their weights.
template <std::size_t width>
void look_up(const float *light, std::size_t stride, std::size_t nodes,
             const DirectionGrid::Corner &sun, const DirectionGrid::Corner &observer, float *out) {
  float sum[width]{};
  for (std::size_t s = 0; s < 4; ++s)
    for (std::size_t o = 0; o < 4; ++o) {
      const float w = sun.weight[s] * observer.weight[o];
      const float *const at = light + (sun.node[s] * nodes + observer.node[o]) * stride;
      for (std::size_t l = 0; l < width; ++l)
        sum[l] += w * at[l];
    }
  std::copy_n(sum, width, out);
}

} // namespace

std::shared_ptr<const DirectionTable> DirectionTable::make(const PoseLighting &light,
                                                           std::size_t cells, double sun_radius_rad,
                                                           unsigned threads) {
  auto out = std::make_shared<DirectionTable>();
  out->cells_ = cells;
  const DirectionGrid grid{cells};
  const std::size_t nodes = grid.nodes();
  std::vector<Vec3<Body>> directions;
  for (std::size_t n = 0; n < nodes; ++n)
    directions.push_back(grid.direction(n));
  StokesTable lit;
  std::vector<Pose> poses;
  constexpr std::size_t at_once = 64; // directions of the Sun whose light is held at a time
  for (std::size_t begin = 0; begin < nodes; begin += at_once) {
    const std::size_t end = std::min(begin + at_once, nodes);
    poses.clear();
    for (std::size_t s = begin; s < end; ++s)
      for (std::size_t o = s; o < nodes; ++o)
        poses.push_back({directions[s], directions[o], sun_radius_rad});
    if (!light(poses, lit))
      return nullptr;
    out->bands_ = lit.bands;
    out->stride_ = (lit.bands * 2 + lanes - 1) / lanes * lanes;
    out->light_.resize(nodes * nodes * out->stride_);
    std::vector<std::size_t> first(end - begin + 1, 0);
    for (std::size_t s = begin; s < end; ++s)
      first[s - begin + 1] = first[s - begin] + nodes - s;
    parallel_for(end - begin, threads, [&](std::size_t k) {
      const std::size_t s = begin + k;
      for (std::size_t o = s; o < nodes; ++o)
        for (std::size_t b = 0; b < lit.bands; ++b) {
          const std::size_t from = (first[k] + o - s) * lit.bands + b;
          const bool is_lit = std::isfinite(lit.i[from]) && std::isfinite(lit.q[from]);
          const float i = is_lit ? static_cast<float>(lit.i[from]) : 0;
          const float q = is_lit ? static_cast<float>(lit.q[from]) : 0;
          for (const std::size_t pair : {s * nodes + o, o * nodes + s}) {
            out->light_[pair * out->stride_ + b * 2] = i;
            out->light_[pair * out->stride_ + b * 2 + 1] = q;
          }
        }
    });
  }
  return out;
}

Result<std::shared_ptr<const DirectionTable>> DirectionTable::halved() const {
  if (cells_ == 0 || cells_ % 2 != 0)
    return fail(ErrorCode::BadInput, "a table of " + std::to_string(cells_) +
                                         " cells a side has no half: it takes an even number");
  auto out = std::make_shared<DirectionTable>();
  out->cells_ = cells_ / 2;
  out->bands_ = bands_;
  out->stride_ = stride_;
  const DirectionGrid few{out->cells_}, all{cells_};
  const auto in_all = [&](std::size_t node) {
    return 2 * (node / (few.cells + 1) * (all.cells + 1) + node % (few.cells + 1));
  };
  for (std::size_t sun = 0; sun < few.nodes(); ++sun)
    for (std::size_t observer = 0; observer < few.nodes(); ++observer) {
      const auto pair = (in_all(sun) * all.nodes() + in_all(observer)) * stride_;
      const auto from = light_.begin() + static_cast<std::ptrdiff_t>(pair);
      out->light_.insert(out->light_.end(), from, from + static_cast<std::ptrdiff_t>(stride_));
    }
  return out;
}

PoseLighting DirectionTable::lighting(std::shared_ptr<const DirectionTable> table,
                                      unsigned threads) {
  return [table, threads](std::span<const Pose> poses, StokesTable &out) {
    const DirectionGrid grid{table->cells_};
    const std::size_t bands = table->bands_, nodes = grid.nodes();
    out.bands = bands; // only what a search reads is made ready
    out.i.resize(poses.size() * bands);
    out.q.resize(poses.size() * bands);
    out.u.resize(poses.size() * bands, 0);
    constexpr std::size_t chunk = 4096;
    const std::size_t stride = table->stride_;
    const float *const light = table->light_.data();
    parallel_for((poses.size() + chunk - 1) / chunk, threads, [&](std::size_t c) {
      std::vector<float> sum(stride);
      for (std::size_t k = c * chunk; k < std::min(poses.size(), (c + 1) * chunk); ++k) {
        const DirectionGrid::Corner sun = grid.corner(poses[k].sun);
        const DirectionGrid::Corner observer = grid.corner(poses[k].observer);
        std::size_t first = 0;
        for (; first + 2 * lanes <= stride; first += 2 * lanes) // up to four bands at once
          look_up<2 * lanes>(light + first, stride, nodes, sun, observer, &sum[first]);
        for (; first < stride; first += lanes)
          look_up<lanes>(light + first, stride, nodes, sun, observer, &sum[first]);
        for (std::size_t b = 0; b < bands; ++b) {
          out.i[k * bands + b] = static_cast<double>(sum[2 * b]);
          out.q[k * bands + b] = static_cast<double>(sum[2 * b + 1]);
        }
      }
    });
    return true;
  };
}

} // namespace umov
