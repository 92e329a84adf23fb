#pragma once
// Private: a level of chains, with the directions in which their ends are free.

#include "light/between/chain_set.h"

namespace umov {

/// Made once; asked for sums after that. Thread safe.
class ChainLevel : public ChainSet {
public:
  /// `level`: which of the drawing. Of no use once `cancel`, which may be null, became true.
  ChainLevel(const ChainDrawn &drawn, const ChainMaterials &materials, std::size_t level,
             unsigned threads, const std::atomic<bool> *cancel);

  /// Adds what the chains carry, in all bands.
  void add(std::span<const backend::ChainPose> poses, std::span<backend::ChainSums> sums) const;
  /// Settles by rays what the grids of visibility leave open to one pose whose `sums`, with their
  /// doubt, were just added up: of a sample of the chains in doubt, so large that the light of all
  /// is known to about `error` (a standard one of I in the first band) from then on.
  void mend(const backend::ChainPose &pose, double error, backend::ChainSums &sums) const;
  /// I that chains which the grids call free carry although a ray is stopped, of all replicates:
  /// asked of a sample. As much is missed, in the mean, of those that they call hidden.
  [[nodiscard]] double mistaken(const backend::ChainPose &pose,
                                const backend::ChainSums &sums) const;

private:
  void add_run(std::size_t number, std::span<const backend::ChainPose> poses,
               std::span<backend::ChainSums> sums) const;
  void add_general(const backend::ChainRun &run, const backend::ChainPose &pose,
                   backend::ChainSums &sums) const;
  /// As often as its grids say, with the doubt in that.
  void add_guessed(const OneChain &chain, const backend::ChainPose &pose, backend::ChainSums &sums,
                   backend::ChainNote &note) const;
  /// A chain of a sample, and how likely it was to be in it.
  struct Chosen {
    std::size_t block, lane;
    double chance;
  };
  /// A sample of the chains that carried, each with a chance of `per` times its number `of` a note,
  /// whose largest is `most`. Calls settle(chosen).
  template <class F>
  void sample(const backend::ChainSums &sums, float (backend::ChainNote::*of)[backend::lanes],
              float backend::ChainNote::*most, double per, const backend::ChainPose &pose,
              F &&settle) const;
  /// What settling a chain reads lies all over the memory: asks for it beforehand.
  void fetch(const Chosen &one, const backend::ChainPose &pose) const;
  /// Above which chance the chains of a block are in the sample.
  using Thresholds = std::array<float, replicates>;
  [[nodiscard]] Thresholds thresholds(std::size_t block) const;
  void set_thresholds(std::uint64_t seed, std::size_t first);
  /// Whether both ends of a chain are free, by the grids around.
  [[nodiscard]] double guessed(const OneChain &chain, const backend::ChainPose &pose) const;

  std::array<float, replicates> shift_{}; ///< of the thresholds by which chains are sampled
  std::vector<float> least_threshold_;    ///< per block
  backend::ChainData view_;
};

} // namespace umov
