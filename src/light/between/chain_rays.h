#pragma once
// Private: chains drawn over all pairs of points that see each other, and on from there.

#include "light/between/bounce_scene.h"
#include "light/between/chain.h"
#include "light/between/chain_cover.h"

#include <atomic>
#include <umov/shape/occluder.h>

namespace umov {

/// Draws chains; what it is made from must live.
class ChainRays {
public:
  ChainRays(const BounceScene &scene, const Occluder &occluder, const ChainCover &cover,
            std::size_t bounces, std::uint64_t seed);

  /// `count` rays of one replicate, from number `first` of its lattice on, and the chains of 2 to
  /// `bounces` surfaces that they find. An estimate by all of them has the mean it should. Of no
  /// use, here and below, once `cancel` (may be null) became true.
  [[nodiscard]] ChainList draw(std::size_t replicate, std::size_t first, std::size_t count,
                               const std::atomic<bool> *cancel) const;
  /// The same thinned to about `kept`, each as likely to stay as it matters over all poses, its
  /// weight growing as it gets rarer, and evenly among like ones. Over all members of the cover.
  [[nodiscard]] ChainList thinned(const ChainList &all, std::size_t replicate, std::size_t first,
                                  std::size_t kept, const std::atomic<bool> *cancel) const;
  /// Where in the sequences by which chains are looked at the first of a list stands.
  [[nodiscard]] std::uint64_t number_of_first(std::size_t replicate, std::size_t first) const {
    return (static_cast<std::uint64_t>(replicate) << 56U) + first * bounces_;
  }
  /// How much a chain matters over all poses; `number` in those sequences.
  [[nodiscard]] double matters(const ChainList &all, std::size_t chain, std::uint64_t number) const;
  /// Root of the part of an end's light that is free, of a surface that sends it in these ways,
  /// each as much: asked of eight rays at most, of all ways alike.
  [[nodiscard]] double freedom(const ChainEnd &end, const std::vector<Sampler> &ways,
                               std::uint64_t stream) const;
  [[nodiscard]] std::size_t bounces() const { return bounces_; }

private:
  struct Walk;
  [[nodiscard]] Vertex start(double x, double v) const;
  [[nodiscard]] ChainEnd end_at(const Vertex &at, Vec3<Body> along) const;
  void put(const Walk &walk, const Vertex &last, Vec3<Body> back, ChainList &out) const;
  /// One surface further: false where the walk ends.
  [[nodiscard]] bool step(Walk &walk, Vertex &at, Vec3<Body> &back,
                          const std::array<double, 4> &u) const;
  /// rms over the members of what a chain carries between all directions of its ends.
  [[nodiscard]] double strength(const ChainList &all, std::size_t chain) const;

  const BounceScene &scene_;
  const Occluder &occluder_;
  const ChainCover &cover_;
  std::size_t bounces_;
  std::uint64_t seed_;
  std::vector<std::uint32_t> side_; ///< 2 * triangle + (1 for its back)
  std::vector<double> sum_;         ///< areas of the sides, added up
};

/// Order in which like chains stand together: surfaces, normals, directions.
std::uint64_t likeness(const Chain &chain);

} // namespace umov
