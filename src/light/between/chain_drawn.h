#pragma once
// Private: chains that were drawn, whatever their surfaces are of: where they begin and end, what
// lies between, and in which directions their ends are free.

#include "backend/chain_data.h"
#include "light/between/chain_trial.h"
#include "light/between/made_once.h"
#include "light/between/replicates.h"

#include <array>
#include <umov/shape/occluder.h>

namespace umov {

/// Cells per edge of the octahedron on which the ends' visibility is held.
inline constexpr std::size_t chain_mask_cells = 32;

/// How many chains there are, and where in each replicate's lattice their rays begin.
struct ChainCount {
  std::size_t first = 0, rays_per_replicate = 0, chains = 0;
};

/// Chains in blocks of 16, one of each replicate.
struct ChainDrawn {
  /// Blocks between the same two kinds of the cover.
  struct Run {
    std::uint32_t first = 0, count = 0;
    std::uint32_t kind_p = 0, kind_q = 0;
    bool is_straight = true;
  };
  std::size_t chains = 0, blocks = 0;
  std::vector<backend::ChainBlock> block;
  std::vector<Run> runs;
  std::vector<std::uint32_t> run_of;                 ///< per block
  std::vector<Occluder::Point> point_p, point_q;     ///< where the ends lie, [block * 16 + lane]
  std::vector<std::uint32_t> triangle_p, triangle_q; ///< of the ends, [block * 16 + lane]
  std::vector<ChainVertex> between;
  /// Into it, of the chains that are not straight: [block * 16 + lane], and one more.
  std::vector<std::uint32_t> first_between;
  /// In which directions of the grid each end is free (backend::ChainMasks), if that was asked.
  std::vector<std::uint16_t> free_p, free_q;
};

/// Draws chains and puts them into blocks; with `grids`, which may be null, for the rays of their
/// ends' visibility. Of no use, here and below, once `cancel`, which may be null, became true.
ChainDrawn draw_chains(const ChainRays &rays, const Occluder *grids, const ChainCount &count,
                       unsigned threads, const std::atomic<bool> *cancel);

/// Chains of one body for a number of materials, drawn when somebody first needs them. Thread safe;
/// `scene` and `occluder` must live.
class ChainDrawing {
public:
  static constexpr std::size_t levels = 3;
  /// Chains of each level, of all replicates; with the levels below they are four times as many as
  /// those.
  static constexpr std::array<std::size_t, levels> chains_of{16'384, 49'152, 196'608};

  /// Throws Failure (Interrupted) once `cancel`, which may be null, became true.
  ChainDrawing(const BounceScene &scene, const Occluder &occluder, ChainCover cover,
               std::size_t bounces, std::uint64_t seed, const std::atomic<bool> *cancel);

  [[nodiscard]] const ChainCover &cover() const { return cover_; }
  [[nodiscard]] const Occluder &occluder() const { return occluder_; }
  [[nodiscard]] std::uint64_t seed() const { return seed_; }
  /// Where in the lattices the rays of a level, after the last of the reserve, after that of the
  /// trial, begin.
  [[nodiscard]] static ChainCount count_of(std::size_t level);
  /// A level, or after the last the reserve. Null if `cancel` became true.
  [[nodiscard]] const ChainDrawn *drawn(std::size_t level, unsigned threads,
                                        const std::atomic<bool> *cancel) const;
  /// ChainTrial::serves. Throws Failure (Interrupted) once `cancel` became true.
  [[nodiscard]] bool serves(const Scene &scene, const ChainSurfaces &surfaces,
                            const std::atomic<bool> *cancel) const;

private:
  ChainCover cover_;
  ChainRays rays_;
  const Occluder &occluder_;
  Occluder grids_; ///< for the many rays of the ends' visibility
  std::uint64_t seed_;
  mutable std::array<MadeOnce<ChainDrawn>, levels + 1> drawn_;
  mutable MadeOnce<ChainTrial> trial_;
};

} // namespace umov
