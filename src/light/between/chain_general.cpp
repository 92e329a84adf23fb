// Chains whose surfaces have no form for the vector unit, lit one by one.

#include "light/between/chain_level.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

/// Part of a ray bundle that is free, interpolated between the directions around.
double share_of(const std::vector<std::uint16_t> &free, const backend::GridLook &look,
                std::size_t blocks, std::size_t block, std::size_t lane) {
  double out = 0;
  for (std::size_t k = 0; k < 3; ++k)
    out += (free[look.direction[k] * blocks + block] >> lane & 1U) *
           static_cast<double>(look.weight[k]);
  return out;
}
/// The lanes of which anything is free.
std::uint32_t any_of(const std::vector<std::uint16_t> &free, const backend::GridLook &look,
                     std::size_t blocks, std::size_t block) {
  std::uint32_t out = 0;
  for (const std::uint32_t direction : look.direction)
    out |= free[direction * blocks + block];
  return out;
}

} // namespace

double ChainLevel::guessed(const OneChain &one, const backend::ChainPose &pose) const {
  return share_of(one.is_reversed ? drawn_.free_q : drawn_.free_p, pose.at_observer, blocks(),
                  one.block, one.lane) *
         share_of(one.is_reversed ? drawn_.free_p : drawn_.free_q, pose.at_sun, blocks(), one.block,
                  one.lane);
}

void ChainLevel::add_general(const backend::ChainRun &run, const backend::ChainPose &pose,
                             backend::ChainSums &sums) const {
  for (std::size_t block = run.first; block < run.first + run.count; ++block) {
    const std::uint32_t open[2] = {any_of(drawn_.free_p, pose.at_observer, blocks(), block) &
                                       any_of(drawn_.free_q, pose.at_sun, blocks(), block),
                                   any_of(drawn_.free_q, pose.at_observer, blocks(), block) &
                                       any_of(drawn_.free_p, pose.at_sun, blocks(), block)};
    if ((open[0] | open[1]) == 0)
      continue;
    backend::ChainNote note{static_cast<std::uint32_t>(block), {}, {}, 0, 0};
    for (std::size_t lane = 0; lane < replicates; ++lane)
      for (const bool is_reversed : {false, true})
        if ((open[is_reversed ? 1 : 0] >> lane & 1U) != 0)
          add_guessed({run, block, lane, is_reversed}, pose, sums, note);
    if (!sums.notes.empty())
      keep_note(note, sums);
  }
}

void ChainLevel::add_guessed(const OneChain &one, const backend::ChainPose &pose,
                             backend::ChainSums &sums, backend::ChainNote &note) const {
  const double share = guessed(one, pose), before = sums.bands[0].i[one.lane];
  if (!(share > 0))
    return;
  add_one(one, share, pose, sums);
  const double carried = sums.bands[0].i[one.lane] - before;
  note.doubt[one.lane] += static_cast<float>(carried * std::sqrt(std::max(1 / share - 1, 0.0)));
  note.carried[one.lane] += static_cast<float>(carried);
}

} // namespace umov
