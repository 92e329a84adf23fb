// Chains whose ends the grids of visibility do not settle: a sample of them, by rays.

#include "light/between/chain_level.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <umov/core/random.h>

namespace umov {
namespace {

/// Chains that are sampled, at least, and at most in parts of all there are.
constexpr double least_sample = 64, largest_part = 1.0 / 64;
/// Chains of which it is asked whether the grids' yes is true.
constexpr double asked = 256;
/// A guess closer than this to sure is not in doubt (ChainNote::doubt has the same).
constexpr double sure = 0.99999;
/// As many chains of a sample are on their way from memory while one is settled.
constexpr std::size_t ahead = 12;
/// Steps of Kronecker's sequence: chains that stand together are alike, and their thresholds far
/// apart.
constexpr double golden = 0.6180339887498949;

} // namespace

void ChainLevel::set_thresholds(std::uint64_t seed, std::size_t first) {
  constexpr std::uint32_t doubt_stream = 0xC4B0;
  for (std::size_t r = 0; r < replicates; ++r)
    shift_[r] = static_cast<float>(uniform4(seed, doubt_stream, first + r)[0]);
  least_threshold_.resize(blocks());
  for (std::size_t block = 0; block < blocks(); ++block) {
    const Thresholds all = thresholds(block);
    least_threshold_[block] = *std::min_element(all.begin(), all.end());
  }
}

ChainLevel::Thresholds ChainLevel::thresholds(std::size_t block) const {
  const double step = golden * static_cast<double>(block);
  const auto along = static_cast<float>(step - std::floor(step));
  Thresholds out{};
  for (std::size_t lane = 0; lane < replicates; ++lane) {
    const float sum = along + shift_[lane];
    out[lane] = sum < 1 ? sum : sum - 1;
  }
  return out;
}

void ChainLevel::fetch(const Chosen &one, const backend::ChainPose &pose) const {
  for (const backend::GridLook *look : {&pose.at_sun, &pose.at_observer})
    for (const std::uint32_t direction : look->direction)
      for (const auto *free : {&drawn_.free_p, &drawn_.free_q})
        __builtin_prefetch(&(*free)[direction * blocks() + one.block]);
  const std::size_t at = one.block * replicates + one.lane;
  __builtin_prefetch(&drawn_.point_p[at]);
  __builtin_prefetch(&drawn_.point_q[at]);
  for (const backend::ChainEnds *end : {&drawn_.block[one.block].p, &drawn_.block[one.block].q})
    for (const auto &axis : end->normal)
      __builtin_prefetch(&axis[one.lane]);
}

template <class F>
void ChainLevel::sample(const backend::ChainSums &sums,
                        float (backend::ChainNote::*of)[backend::lanes],
                        float backend::ChainNote::*most, double per, const backend::ChainPose &pose,
                        F &&settle) const {
  const auto scale = static_cast<float>(per);
  std::vector<Chosen> chosen;
  for (std::size_t n = 0; n < sums.noted; ++n) {
    const backend::ChainNote &note = sums.notes[n];
    if (!(note.*most > 0) || scale * (note.*most) <= least_threshold_[note.block])
      continue; // few blocks are left, and few chains of theirs
    const Thresholds threshold = thresholds(note.block);
    for (std::size_t lane = 0; lane < replicates; ++lane) {
      const float part = (note.*of)[lane]; // where all are faint, the scale may be infinite
      const float chance = part > 0 ? std::min(1.0f, scale * part) : 0.0f;
      if (chance > threshold[lane])
        chosen.push_back({note.block, lane, static_cast<double>(chance)});
    }
  }
  for (std::size_t k = 0; k < chosen.size() + ahead; ++k) {
    if (k < chosen.size())
      fetch(chosen[k], pose);
    if (k >= ahead)
      settle(chosen[k - ahead]);
  }
}

void ChainLevel::mend(const backend::ChainPose &pose, double error,
                      backend::ChainSums &sums) const {
  // Doubts that are independent leave the sum of n of them, each taken in proportion to its own,
  // with (sum of all)/sqrt(n).
  const double doubt = sums.doubt;
  if (!(doubt > 0))
    return;
  const double most = std::max(least_sample, largest_part * static_cast<double>(chains())),
               wanted = std::pow(doubt / (replicates * error), 2);
  sample(sums, &backend::ChainNote::doubt, &backend::ChainNote::most_doubt,
         std::clamp(wanted, least_sample, most) / doubt, pose, [&](const Chosen &of) {
           for (const bool is_reversed : {false, true}) {
             const OneChain one{run_at(of.block), of.block, of.lane, is_reversed};
             const double guess = guessed(one, pose);
             if (guess > 0 && guess < sure)
               add_one(one, ((is_free(one, pose) ? 1 : 0) - guess) / of.chance, pose, sums);
           }
         });
}

double ChainLevel::mistaken(const backend::ChainPose &pose, const backend::ChainSums &sums) const {
  if (!(sums.carried > 0))
    return 0;
  std::vector<backend::ChainLight> light(bands_);
  backend::ChainSums wrong;
  wrong.bands = light;
  sample(sums, &backend::ChainNote::carried, &backend::ChainNote::most_carried,
         asked / sums.carried, pose, [&](const Chosen &of) {
           for (const bool is_reversed : {false, true}) {
             const OneChain one{run_at(of.block), of.block, of.lane, is_reversed};
             if (guessed(one, pose) >= sure && !is_free(one, pose))
               add_one(one, 1 / of.chance, pose, wrong);
           }
         });
  return std::accumulate(std::begin(light[0].i), std::end(light[0].i), 0.0);
}

} // namespace umov
