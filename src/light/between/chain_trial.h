#pragma once
// Private: whether chains that were drawn for some materials tell the light of others.

#include "light/between/chain_rays.h"

namespace umov {

/// Some chains as they are found, before any is thinned away: of all numbers of surfaces alike,
/// however dark these are. What it is made from must live.
class ChainTrial {
public:
  /// Its rays are a replicate's from number `first` on. Throws Failure (Interrupted), here and
  /// below, once `cancel`, which may be null, became true.
  ChainTrial(const ChainRays &rays, const ChainCover &cover, std::size_t first,
             const std::atomic<bool> *cancel);

  /// Chains that a cover's materials have kept tell the light of these ones, too: nowhere is much
  /// of it carried by so few that a pose which meets none of them would not know
  /// (docs/theory/bounces.md, "Other materials").
  [[nodiscard]] bool serves(const Scene &scene, const ChainSurfaces &surfaces,
                            const std::atomic<bool> *cancel) const;

private:
  /// What a chain carries of the light of other materials, and how likely it was kept; in no unit.
  struct Portion {
    double light = 0, kept = 0;
  };
  [[nodiscard]] std::vector<double> light_of(const Scene &scene, const ChainSurfaces &surfaces,
                                             std::size_t chain, class ChainMatrices &of) const;
  [[nodiscard]] bool serves_rare_ones(const Scene &scene) const;
  /// `light`: per chain, of one band.
  [[nodiscard]] bool is_even_in(const std::vector<double> &light) const;
  static bool is_even(std::vector<Portion> all);

  const ChainRays &rays_;
  const ChainCover &cover_;
  std::uint64_t number_ = 0; ///< of the first chain (ChainRays::matters)
  ChainList list_;
  std::vector<double> kept_;      ///< per chain: how much it matters to the cover's materials
  std::vector<std::size_t> met_;  ///< per kind: how often chains are on it
  std::vector<std::size_t> pair_; ///< per chain: of which two kinds its ends are
  std::size_t pairs_ = 0;
};

} // namespace umov
