#pragma once
// Private: drawn chains of given materials as poses ask them.

#include "light/between/chain_drawn.h"

#include <umov/scene/pose.h>

namespace umov {

/// What chains are lit with.
struct ChainMaterials {
  const Scene &scene;
  const ChainSurfaces &surfaces; ///< of the scene
  const ChainDrawing &drawing;
};

/// Chains that stand in blocks, and the light of one of them. What it is made from must live.
class ChainSet {
public:
  ChainSet(const ChainSet &) = delete; // views point into it
  ChainSet &operator=(const ChainSet &) = delete;
  [[nodiscard]] std::size_t chains() const { return drawn_.chains; }
  [[nodiscard]] std::size_t blocks() const { return drawn_.blocks; }

protected:
  /// Matrices of what lies between the ends, without rays. Of no use once `cancel`, which may be
  /// null, became true.
  ChainSet(const ChainDrawn &drawn, const ChainMaterials &materials, unsigned threads,
           const std::atomic<bool> *cancel);
  ~ChainSet() = default;

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
    return runs_[drawn_.run_of[block]];
  }

  const ChainDrawn &drawn_;
  const ChainSurfaces &surfaces_;
  const Occluder &occluder_;
  std::size_t bands_;
  std::vector<backend::ChainMatrix> matrix_;
  std::vector<backend::ChainRun> runs_; ///< those of `drawn_`
  std::vector<char> is_left_;           ///< per run: paths draw all of it
  std::vector<char> is_general_;        ///< per run: lit one by one
  std::vector<float> transmitted_;      ///< of I in the mean of the bands, [block * 16 + lane]

private:
  void put_runs(const ChainCover &cover, const Scene &scene);
  void fill(const Scene &scene, unsigned threads, const std::atomic<bool> *cancel);
  [[nodiscard]] Vec3<Body> field_of(std::uint32_t kind, std::uint32_t triangle) const;

  const Mesh &mesh_;
};

/// Of one of 16 side by side.
inline Vec3<Body> vector_of(const float (&from)[3][backend::lanes], std::size_t lane) {
  return {from[0][lane], from[1][lane], from[2][lane]};
}

/// A pose as chains see it.
backend::ChainPose chain_pose(const Pose &pose);

} // namespace umov
