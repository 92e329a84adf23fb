#pragma once
// Private: a set of chains as a pose asks them: by blocks of 16, one of each replicate, with the
// directions in which their ends are free.

#include "backend/chain_data.h"
#include "light/between/chain_rays.h"
#include "light/between/replicates.h"

#include <array>
#include <umov/scene/pose.h>

namespace umov {

/// Cells per edge of the octahedron on which the ends' visibility is held.
inline constexpr std::size_t chain_mask_cells = 32;

/// Drawn once; asked for sums after that. Thread safe.
class ChainLevel {
public:
  /// `count` chains of rays `first` ... of each replicate's lattice, `grids` for the rays of their
  /// ends' visibility. Of no use once `cancel`, which may be null, became true.
  ChainLevel(const ChainRays &rays, const ChainSurfaces &surfaces, const Occluder &occluder,
             const Occluder &grids, std::size_t bands, std::size_t first,
             std::size_t rays_per_replicate, std::size_t count, std::uint64_t seed,
             unsigned threads, const std::atomic<bool> *cancel);
  ChainLevel(const ChainLevel &) = delete; // views point into it
  ChainLevel &operator=(const ChainLevel &) = delete;

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
  [[nodiscard]] std::size_t chains() const { return chains_; }
  [[nodiscard]] std::size_t blocks() const { return blocks_; }
  [[nodiscard]] std::size_t bytes() const;

private:
  struct Placed {
    std::size_t block, lane;
    const Chain *chain;
  };
  [[nodiscard]] std::vector<Placed> arrange(const std::vector<ChainList> &lists);
  void fill(const std::vector<Placed> &placed, const std::vector<ChainList> &lists);
  void trace(const std::vector<Placed> &placed, const Occluder &grids, unsigned threads,
             const std::atomic<bool> *cancel);
  void add_general(const backend::ChainRun &run, const backend::ChainPose &pose,
                   backend::ChainSums &sums) const;
  /// A chain, in which direction it is taken, and what about its ends.
  struct OneChain {
    const backend::ChainRun &run;
    std::size_t block, lane;
    bool is_reversed = false; ///< the observer at q
    [[nodiscard]] std::size_t at() const { return block * replicates + lane; }
  };
  /// As often as `free` says.
  void add_one(const OneChain &chain, double free, const backend::ChainPose &pose,
               backend::ChainSums &sums) const;
  /// As often as its grids say, with the doubt in that.
  void add_guessed(const OneChain &chain, const backend::ChainPose &pose, backend::ChainSums &sums,
                   backend::ChainNote &note) const;
  /// A sample of the chains that carried, each with a chance of `per` times its number `of` a note,
  /// whose largest is `most`. Calls chosen(run, block, lane, chance).
  template <class F>
  void sample(const backend::ChainSums &sums, float (backend::ChainNote::*of)[backend::lanes],
              float backend::ChainNote::*most, double per, F &&chosen) const;
  /// Above which chance the chains of a block are in the sample.
  using Thresholds = std::array<float, replicates>;
  [[nodiscard]] Thresholds thresholds(std::size_t block) const;
  void set_thresholds(std::uint64_t seed, std::size_t first);
  /// Whether both ends of a chain are free: by the grids around, and by rays.
  [[nodiscard]] double guessed(const OneChain &chain, const backend::ChainPose &pose) const;
  [[nodiscard]] bool is_free(const OneChain &chain, const backend::ChainPose &pose) const;

  const ChainSurfaces &surfaces_;
  const Occluder &occluder_;
  std::array<float, replicates> shift_{}; ///< of the thresholds by which chains are sampled
  std::vector<float> least_threshold_;    ///< per block
  std::size_t bands_, chains_ = 0, blocks_ = 0;
  std::vector<backend::ChainBlock> block_;
  std::vector<backend::ChainMatrix> matrix_;
  std::vector<backend::ChainRun> runs_;
  std::vector<std::uint32_t> run_of_;              ///< per block
  std::vector<char> is_general_;                   ///< per run: lit one by one
  std::vector<Vec3<Body>> field_p_, field_q_;      ///< of those, [block * 16 + lane]
  std::vector<Occluder::Point> point_p_, point_q_; ///< where the ends lie, [block * 16 + lane]
  std::vector<std::uint16_t> free_p_, free_q_;
  backend::ChainData view_;
};

/// A pose as chains see it.
backend::ChainPose chain_pose(const Pose &pose);

} // namespace umov
