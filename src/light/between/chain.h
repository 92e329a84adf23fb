#pragma once
// Private: what a way between surfaces is, however the body is lit.

#include "light/between/bounce_scene.h"

#include <umov/optics/stokes.h>
#include <vector>

namespace umov {

/// One end of a chain: where light comes in from the Sun, or leaves to the observer.
struct ChainEnd {
  Vec3<Body> point{}, face{}, normal{}, field{};
  Vec3<Body> along{}; ///< unit, to the next surface of the chain
  Vec3<Body> axis{};  ///< of the beam at this end: normal x along
  const Surface *surface = nullptr;
  const Sampler *sampler = nullptr;
  std::uint32_t kind = 0; ///< of surface: into ChainSurfaces
};

/// What happens to light between its first and its last reflection: a fact of the body alone.
struct Chain {
  ChainEnd p, q;
  /// Area times solid angle over how likely it was drawn, with the cosines at the chain's side of
  /// each surface: with the observer at p, and with the observer at q.
  double from_p = 0, from_q = 0;
  bool is_straight = true;  ///< nothing in between
  std::uint32_t matrix = 0; ///< into ChainList::between, else
  double transmitted = 1;   ///< of I, over all bands: how much it counts
};

/// Chains with the Mueller matrices of what lies between their ends, from the axis of q to that of
/// p: [(matrix * bands + band) * 16 + 4 * row + column].
struct ChainList {
  std::vector<Chain> chains;
  std::vector<float> between;
};

} // namespace umov
