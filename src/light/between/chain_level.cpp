#include "light/between/chain_level.h"

#include <algorithm>
#include <numeric>

namespace umov {
namespace {

/// Blocks that several poses are lit by in turn, while the cache has them.
constexpr std::size_t blocks_at_a_time = backend::chain_blocks_together;
} // namespace

ChainLevel::ChainLevel(const ChainDrawn &drawn, const ChainMaterials &materials, std::size_t level,
                       unsigned threads, const std::atomic<bool> *cancel)
    : ChainSet(drawn, materials, threads, cancel) {
  set_thresholds(materials.drawing.seed(), ChainDrawing::count_of(level).first);
  view_ = {drawn.block, matrix_, surfaces_.fast(), {drawn.blocks, drawn.free_p, drawn.free_q},
           bands_,      {}};
}

namespace {

/// I in the first band so far.
double light_of(const backend::ChainSums &sums) {
  return std::accumulate(std::begin(sums.bands[0].i), std::end(sums.bands[0].i), 0.0);
}

} // namespace

void ChainLevel::add(std::span<const backend::ChainPose> poses,
                     std::span<backend::ChainSums> sums) const {
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const backend::ChainRun &run = runs_[r];
    if (is_left_[r] != 0)
      continue;
    if (run.is_without_lobes || !surfaces_.is_narrow(run.kind_p) ||
        !surfaces_.is_narrow(run.kind_q)) {
      add_run(r, poses, sums);
      continue;
    }
    // Counted apart: where the many chains of wide light hide them nobody would see that they are
    // few.
    std::vector<double> light, squares;
    for (const backend::ChainSums &sum : sums) {
      light.push_back(light_of(sum));
      squares.push_back(sum.squares);
    }
    add_run(r, poses, sums);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      sums[k].narrow_i += light_of(sums[k]) - light[k];
      sums[k].narrow_squares += sums[k].squares - squares[k];
    }
  }
}

void ChainLevel::add_run(std::size_t number, std::span<const backend::ChainPose> poses,
                         std::span<backend::ChainSums> sums) const {
  const backend::ChainRun &run = runs_[number];
  if (is_general_[number] != 0) {
    for (std::size_t k = 0; k < poses.size(); ++k)
      add_general(run, poses[k], sums[k]);
    return;
  }
  for (std::size_t begin = 0; begin < run.count; begin += blocks_at_a_time) {
    const std::size_t count = std::min<std::size_t>(blocks_at_a_time, run.count - begin);
    for (std::size_t k = 0; k < poses.size(); ++k)
      for (std::size_t band = 0; band < bands_; band += backend::chain_bands_max)
        backend::sum_chains(view_, run, begin, count, band, poses[k], sums[k]);
  }
}

} // namespace umov
