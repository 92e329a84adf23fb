#pragma once
// Private: one set of random points over the lit elements, and what they say.

#include "light/reference/visibility.h"

namespace umov {

/// Lit elements [first, last) that share their points: one element cut into `cuts`^2 cells, or
/// several small ones drawn by their share (cuts = 0). Each cell, or the several, has two points.
struct Block {
  std::size_t first = 0, last = 0;
  std::size_t cuts = 0;
  double spread = 0;  ///< sampling variance per cell, relative to the unhidden light, band mean
  double weight2 = 0; ///< square of one cell's part of the unhidden light
  [[nodiscard]] std::size_t cells() const { return cuts == 0 ? 1 : cuts * cuts; }
};

struct Measurement {
  VisibleSums sums;
  std::vector<Block> blocks;
};

/// Blocks for the wanted number of cells of each lit element (a fraction shares a cell).
std::vector<Block> make_blocks(const LitElements &lit, const std::vector<double> &cells);

/// Draws and traces the points of `blocks`; `stream` names the independent set. Throws as
/// sum_visible.
Measurement measure(const Scene &scene, const Elements &elements, const Occluder &occluder,
                    const PoseGeometry &pose, const LitElements &lit, std::vector<Block> blocks,
                    std::uint64_t seed, std::uint32_t stream, const std::atomic<bool> *cancel);

} // namespace umov
