#pragma once
// Private: a set of chains as a pose asks them: by blocks of 16, one of each replicate, with the
// directions in which their ends are free.

#include "backend/chain_data.h"
#include "light/between/chain_rays.h"
#include "light/between/replicates.h"

#include <umov/scene/pose.h>

namespace umov {

/// Cells per edge of the octahedron on which the ends' visibility is held.
inline constexpr std::size_t chain_mask_cells = 32;

/// Drawn once; asked for sums after that. Thread safe.
class ChainLevel {
public:
  /// `count` chains of rays `first` ... of each replicate's lattice.
  ChainLevel(const ChainRays &rays, const ChainSurfaces &surfaces, const Occluder &occluder,
             std::size_t bands, std::size_t first, std::size_t rays_per_replicate,
             std::size_t count, unsigned threads);
  ChainLevel(const ChainLevel &) = delete; // views point into it
  ChainLevel &operator=(const ChainLevel &) = delete;

  /// Adds what the chains carry, in all bands.
  void add(std::span<const backend::ChainPose> poses, std::span<backend::ChainSums> sums) const;
  [[nodiscard]] std::size_t chains() const { return chains_; }
  [[nodiscard]] std::size_t bytes() const;

private:
  struct Placed {
    std::size_t block, lane;
    const Chain *chain;
  };
  [[nodiscard]] std::vector<Placed> arrange(const std::vector<ChainList> &lists);
  void fill(const std::vector<Placed> &placed, const std::vector<ChainList> &lists);
  void trace(const std::vector<Placed> &placed, const Occluder &occluder, unsigned threads);
  void add_general(const backend::ChainRun &run, const backend::ChainPose &pose,
                   backend::ChainSums &sums) const;
  /// One chain of those, with the observer at p, or at q.
  void add_one(const backend::ChainRun &run, std::size_t block, std::size_t lane, bool is_reversed,
               const backend::ChainPose &pose, backend::ChainSums &sums) const;

  const ChainSurfaces &surfaces_;
  std::size_t bands_, chains_ = 0, blocks_ = 0;
  std::vector<backend::ChainBlock> block_;
  std::vector<backend::ChainMatrix> matrix_;
  std::vector<backend::ChainRun> runs_;
  std::vector<char> is_general_;              ///< per run: lit one by one
  std::vector<Vec3<Body>> field_p_, field_q_; ///< of those, [block * 16 + lane]
  std::vector<std::uint16_t> free_p_, free_q_;
  backend::ChainData view_;
};

/// A pose as chains see it.
backend::ChainPose chain_pose(const Pose &pose);

} // namespace umov
