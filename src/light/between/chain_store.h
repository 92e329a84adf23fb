#pragma once
// Private: light between surfaces for many poses, from chains that are drawn once.

#include "light/between/chain_level.h"
#include "light/between/chain_reserve.h"
#include "light/between/made_once.h"

#include <atomic>
#include <memory>
#include <span>
#include <umov/core/stop.h>
#include <umov/light/integrator.h>

namespace umov {

/// Chains of one body and its materials, in levels that are made when a pose first needs them. The
/// bytes of an answer depend on the scene and on what the chains were drawn for, not on threads or
/// on what was asked before. Thread safe; what it is made from must live.
class ChainStore {
public:
  /// Chains that were drawn for this scene or serve it (ChainTrial); `surfaces` of the scene.
  ChainStore(std::shared_ptr<const ChainDrawing> drawing, const Scene &scene,
             std::shared_ptr<const ChainSurfaces> surfaces);

  struct Answer {
    std::vector<IndirectLight> light;
    std::vector<char> is_enough; ///< per pose: enough chains were met to believe the half-widths
  };
  /// Each pose climbs until the half-width of I is below options.accuracy of the whole, direct_i
  /// included, or the levels end, or options.max_points chains are spent. Where all levels met too
  /// few, and for bodies of narrow lobes alone, the reserve is asked. Empty if `cancel` became
  /// true.
  [[nodiscard]] Answer light(std::span<const Pose> poses, std::span<const double> direct_i,
                             const IntegrationOptions &options, unsigned threads,
                             const std::atomic<bool> *cancel) const;
  [[nodiscard]] const ChainSurfaces &surfaces() const { return *surfaces_; }
  static constexpr std::size_t levels = ChainDrawing::levels;

private:
  struct Climb;
  /// Null if `cancel` became true.
  [[nodiscard]] const ChainLevel *level(std::size_t index, unsigned threads,
                                        const std::atomic<bool> *cancel) const;
  void add_level(std::size_t index, std::span<const Pose> poses, std::span<const double> direct_i,
                 const IntegrationOptions &options, Climb &climb, unsigned threads,
                 const std::atomic<bool> *cancel) const;

  void climb(std::span<const Pose> poses, std::span<const double> direct_i,
             const IntegrationOptions &options, Answer &answer, unsigned threads,
             const std::atomic<bool> *cancel) const;
  const ChainReserve *reserve(unsigned threads, const std::atomic<bool> *cancel) const;
  void ask_reserve(std::span<const Pose> poses, std::span<const double> direct_i,
                   const IntegrationOptions &options, Answer &answer, unsigned threads,
                   const std::atomic<bool> *cancel) const;

  std::shared_ptr<const ChainDrawing> drawing_;
  std::shared_ptr<const ChainSurfaces> surfaces_;
  ChainMaterials materials_;
  std::size_t bands_;
  mutable std::array<MadeOnce<ChainLevel>, levels> level_;
  mutable MadeOnce<ChainReserve> reserve_;
};

} // namespace umov
