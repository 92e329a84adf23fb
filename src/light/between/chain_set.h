#pragma once
// Private: chains as poses ask them, by blocks of 16, one of each replicate.

#include "backend/chain_data.h"
#include "light/between/chain_rays.h"
#include "light/between/replicates.h"

#include <array>
#include <umov/scene/pose.h>

namespace umov {

/// Cells per edge of the octahedron on which the ends' visibility is held.
inline constexpr std::size_t chain_mask_cells = 32;

/// How many chains there are, and where in each replicate's lattice their rays begin.
struct ChainCount {
  std::size_t first = 0, rays_per_replicate = 0, chains = 0;
};

/// Chains that stand in blocks, and the light of one of them. What it is made from must live.
class ChainSet {
public:
  ChainSet(const ChainSet &) = delete; // views point into it
  ChainSet &operator=(const ChainSet &) = delete;
  [[nodiscard]] std::size_t chains() const { return chains_; }
  [[nodiscard]] std::size_t blocks() const { return blocks_; }

protected:
  ChainSet(const ChainSurfaces &surfaces, const Occluder &occluder, std::size_t bands)
      : surfaces_(surfaces), occluder_(occluder), bands_(bands) {}
  ~ChainSet() = default;

  struct Placed {
    std::size_t block, lane;
    const Chain *chain;
  };
  struct Drawn {
    std::vector<ChainList> lists;
    std::vector<Placed> placed;
  };
  /// Draws the chains and puts them into blocks. Of no use once `cancel`, which may be null, became
  /// true.
  Drawn draw(const ChainRays &rays, const ChainCount &count, unsigned threads,
             const std::atomic<bool> *cancel);

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
  /// Whether its ends face the Sun and the observer.
  [[nodiscard]] bool faces(const OneChain &chain, const backend::ChainPose &pose) const;
  /// Whether both ends are free, by rays.
  [[nodiscard]] bool is_free(const OneChain &chain, const backend::ChainPose &pose) const;
  [[nodiscard]] const backend::ChainRun &run_at(std::size_t block) const {
    return runs_[run_of_[block]];
  }

  const ChainSurfaces &surfaces_;
  const Occluder &occluder_;
  std::size_t bands_, chains_ = 0, blocks_ = 0;
  std::vector<backend::ChainBlock> block_;
  std::vector<backend::ChainMatrix> matrix_;
  std::vector<backend::ChainRun> runs_;
  std::vector<std::uint32_t> run_of_;              ///< per block
  std::vector<char> is_general_;                   ///< per run: lit one by one
  std::vector<Vec3<Body>> field_p_, field_q_;      ///< if any is asked for, [block * 16 + lane]
  std::vector<Occluder::Point> point_p_, point_q_; ///< where the ends lie, [block * 16 + lane]

private:
  [[nodiscard]] std::vector<Placed> arrange(const std::vector<ChainList> &lists);
  void fill(const std::vector<Placed> &placed, const std::vector<ChainList> &lists);
};

/// A pose as chains see it.
backend::ChainPose chain_pose(const Pose &pose);

} // namespace umov
