#include "light/model/band_sums.h"

#include <algorithm>
#include <umov/core/parallel.h>

namespace umov {
namespace {

using Light = Stokes<ScatteringPlane>;

/// One pose in one band.
void sum_pose(const StokesTable &nodes, std::size_t from, const std::vector<BandTerm> &terms,
              std::size_t to, std::size_t band, StokesTable &out) {
  const auto light =
      sum_band<Light>(terms, [&](std::size_t node) { return nodes.at(from, node).stokes; });
  const auto half_width =
      sum_band<Light>(terms, [&](std::size_t node) { return nodes.at(from, node).half_width; });
  out.put(to, band, {light.value, half_width.value});
  const std::size_t at = to * out.bands + band;
  const Light &change = light.change;
  out.band_err[at] = {std::abs(change.i), std::abs(change.q), std::abs(change.u),
                      std::abs(change.v)};
  if (!out.indirect.empty())
    out.indirect[at] = sum_band<Light>(terms, [&](std::size_t node) {
                         return nodes.indirect[from * nodes.bands + node];
                       }).value;
}

} // namespace

void size_as(const StokesTable &nodes, const BandGrid &grid, std::size_t poses,
             std::size_t materials, StokesTable &out) {
  out.resize(poses, grid.terms().size());
  out.band_err.resize(out.i.size());
  out.indirect.resize(nodes.indirect.empty() ? 0 : out.i.size());
  out.glint_share.resize(nodes.glint_share.empty() ? 0 : poses);
  out.material_i.resize(nodes.material_i.empty() ? 0 : out.i.size() * materials);
}

namespace {

/// All bands of one pose.
void sum_all(const StokesTable &nodes, std::size_t k, const BandGrid &grid, std::size_t materials,
             std::size_t row, StokesTable &out) {
  out.is_dark[row] = nodes.is_dark[k];
  out.method[row] = nodes.method[k];
  if (!out.glint_share.empty())
    out.glint_share[row] = nodes.glint_share[k];
  for (std::size_t b = 0; b < out.bands; ++b) {
    sum_pose(nodes, k, grid.terms()[b], row, b, out);
    for (std::size_t m = 0; m < materials && !out.material_i.empty(); ++m)
      out.material_i[(row * materials + m) * out.bands + b] =
          sum_band<double>(grid.terms()[b], [&](std::size_t node) {
            return nodes.material_i[(k * materials + m) * nodes.bands + node];
          }).value;
  }
}

} // namespace

void sum_bands(const StokesTable &nodes, const BandGrid &grid, std::size_t materials,
               std::size_t begin, unsigned threads, StokesTable &out) {
  constexpr std::size_t part = 256;
  const std::size_t count = nodes.poses();
  parallel_for((count + part - 1) / part, threads, [&](std::size_t task) {
    for (std::size_t k = task * part; k < std::min(count, (task + 1) * part); ++k)
      sum_all(nodes, k, grid, materials, begin + k, out);
  });
}

} // namespace umov
