#pragma once
// Private: many chains, of which a pose takes those that matter to it.

#include "light/between/chain_set.h"

namespace umov {

/// Chains for light that few of them meet: from one lobe to another, both fairly narrow. Nothing is
/// known of where their ends are free; a pose draws from them, each as likely as it would carry if
/// nothing were in the way, and settles those by rays. Thread safe.
class ChainReserve : public ChainSet {
public:
  /// Of surfaces that the vector unit computes. Of no use once `cancel`, which may be null, became
  /// true.
  ChainReserve(const ChainDrawn &drawn, const ChainMaterials &materials, unsigned threads,
               const std::atomic<bool> *cancel);

  /// What a pose was told from.
  struct Told {
    double all = 0;             ///< what all chains weigh for it
    std::size_t picks = 0;      ///< how many were settled
    std::vector<double> hidden; ///< where none of them passed: I per band that may do (95 %)
  };
  /// Adds what all of them carry in all bands, told from as many of them as tell the whole light,
  /// with direct_i of each pose in the first band, to about `accuracy`, within limits.
  std::vector<Told> add(std::span<const backend::ChainPose> poses, std::span<const double> direct_i,
                        double accuracy, std::span<backend::ChainSums> sums) const;

private:
  static constexpr std::size_t blocks_of_piece = 64;
  /// Neighbouring blocks of one run.
  struct Piece {
    std::uint32_t run = 0, first = 0, count = 0; ///< first: counted in the run
  };
  /// What all chains would carry, up to a place in their order, and the next pick, by lanes.
  struct Way {
    std::array<double, replicates> passed{}, next{}, step{};
  };
  using Weights = std::array<float, blocks_of_piece * replicates>;
  struct Pick {
    std::size_t block, lane;
    double steps, times; ///< on it, and how often it counts for them
  };
  void weigh(const Piece &piece, const backend::ChainPose &pose, Weights &out) const;
  /// Lists the picks too, in `stopped`, as long as none of them has passed.
  void pick(const Piece &piece, const Weights &weights, const backend::ChainPose &pose, Way &way,
            backend::ChainSums &sums, std::vector<Pick> &stopped) const;
  /// False if rays stop it both ways.
  bool settle(const Pick &pick, const backend::ChainPose &pose, backend::ChainSums &sums) const;
  [[nodiscard]] std::vector<double> hidden(const std::vector<Pick> &stopped,
                                           const backend::ChainPose &pose) const;

  std::vector<Piece> pieces_;
  std::array<double, replicates> shift_{};
  backend::ChainData view_;
};

} // namespace umov
