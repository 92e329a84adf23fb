// Chains whose ends the grids of visibility do not settle: a sample of them, by rays.

#include "light/between/chain_level.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace umov {
namespace {

/// Chains that are sampled, at least, and at most in parts of all there are.
constexpr double least_sample = 64, largest_part = 1.0 / 64;
/// Chains of which it is asked whether the grids' yes is true.
constexpr double asked = 256;
/// A guess closer than this to sure is not in doubt (ChainSums::doubt has the same).
constexpr double sure = 0.99999;
/// Steps of Kronecker's sequence: chains that stand together are alike, and their thresholds far
/// apart.
constexpr double golden = 0.6180339887498949;

Occluder::Point point_of(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

} // namespace

bool ChainLevel::is_free(const OneChain &one, const backend::ChainPose &pose) const {
  const auto &seen = one.is_reversed ? point_q_ : point_p_,
             &lit = one.is_reversed ? point_p_ : point_q_;
  const Occluder::Point from[2] = {seen[one.at()], lit[one.at()]},
                        to[2] = {point_of(pose.observer), point_of(pose.sun)};
  for (std::size_t k = 0; k < 2; ++k) {
    unsigned char free = 0;
    occluder_.is_free(std::span(&from[k], 1), std::span(&to[k], 1), std::span(&free, 1));
    if (free == 0)
      return false;
  }
  return true;
}

template <class F>
void ChainLevel::sample(std::span<const float> of, double per, F &&chosen) const {
  for (const backend::ChainRun &run : runs_)
    for (std::size_t block = run.first; block < run.first + run.count; ++block) {
      const double step = golden * static_cast<double>(block), along = step - std::floor(step);
      for (std::size_t lane = 0; lane < replicates; ++lane) {
        const double chance =
            std::min(1.0, per * static_cast<double>(of[block * replicates + lane]));
        const double threshold = along + shift_[lane];
        if (chance > (threshold < 1 ? threshold : threshold - 1))
          chosen(run, block, lane, chance);
      }
    }
}

void ChainLevel::mend(const backend::ChainPose &pose, double error,
                      backend::ChainSums &sums) const {
  // Doubts that are independent leave the sum of n of them, each taken in proportion to its own,
  // with (sum of all)/sqrt(n).
  const std::span<const float> of(sums.doubt.data(), places());
  const double doubt = std::accumulate(of.begin(), of.end(), 0.0);
  if (!(doubt > 0))
    return;
  const double most = std::max(least_sample, largest_part * static_cast<double>(chains_)),
               wanted = std::pow(doubt / (replicates * error), 2);
  sample(of, std::clamp(wanted, least_sample, most) / doubt,
         [&](const backend::ChainRun &run, std::size_t block, std::size_t lane, double chance) {
           for (const bool is_reversed : {false, true}) {
             const OneChain one{run, block, lane, is_reversed};
             const double guess = guessed(one, pose);
             if (guess > 0 && guess < sure)
               add_one(one, ((is_free(one, pose) ? 1 : 0) - guess) / chance, pose, sums);
           }
         });
}

double ChainLevel::mistaken(const backend::ChainPose &pose, const backend::ChainSums &sums) const {
  const std::span<const float> of(sums.carried.data(), places());
  const double carried = std::accumulate(of.begin(), of.end(), 0.0);
  if (!(carried > 0))
    return 0;
  std::vector<backend::ChainLight> light(bands_);
  backend::ChainSums wrong;
  wrong.bands = light;
  sample(of, asked / carried,
         [&](const backend::ChainRun &run, std::size_t block, std::size_t lane, double chance) {
           for (const bool is_reversed : {false, true}) {
             const OneChain one{run, block, lane, is_reversed};
             if (guessed(one, pose) >= sure && !is_free(one, pose))
               add_one(one, 1 / chance, pose, wrong);
           }
         });
  return std::accumulate(std::begin(light[0].i), std::end(light[0].i), 0.0);
}

} // namespace umov
