#pragma once
// Private: what a way between surfaces is, however the body is lit and whatever it is made of.

#include <cstdint>
#include <umov/core/quantity.h>
#include <umov/core/vec3.h>
#include <umov/shape/occluder.h>
#include <vector>

namespace umov {

/// One end of a chain: where light comes in from the Sun, or leaves to the observer. A million of
/// them are drawn at a time, and asked for no more digits than these.
struct ChainEnd {
  Occluder::Point point{};
  float face[3]{}, normal[3]{};
  float along[3]{};                     ///< unit, to the next surface of the chain
  float axis[3]{};                      ///< of the beam at this end: normal x along
  std::uint32_t triangle = 0, slot = 0; ///< slot: of its surface (surface_of_slot)
  std::uint32_t kind = 0;               ///< of surface: into ChainCover
};

/// A surface in between, with the direction in which its chain goes on from there as it was drawn:
/// what its matrix follows from, of any material.
struct ChainVertex {
  float normal[3], to[3];
  float density; ///< [1/sr]; of a mirror's one direction, its probability
  std::uint32_t triangle;
  std::uint32_t slot : 31;
  std::uint32_t is_by_mirror : 1;
};

/// What happens to light between its first and its last reflection: a fact of the body alone.
struct Chain {
  ChainEnd p, q;
  /// Area times solid angle over how likely it was drawn, with the cosines at the chain's side of
  /// each end: with the observer at p, and with the observer at q.
  double from_p = 0, from_q = 0;
  std::uint32_t first = 0, count = 0; ///< of ChainList::between; 0: straight
};

/// Chains, with the surfaces between their ends from p on.
struct ChainList {
  std::vector<Chain> chains;
  std::vector<ChainVertex> between;
  /// Of I, in the mean of the bands: [chain * members of the cover + member].
  std::vector<float> transmitted;
};

inline Vec3<Body> vector_of(const float (&v)[3]) { return {v[0], v[1], v[2]}; }
/// Between its normal and the chain.
inline double cosine_of(const ChainEnd &end) {
  return dot(vector_of(end.normal), vector_of(end.along));
}
inline void put_floats(Vec3<Body> from, float (&to)[3]) {
  to[0] = static_cast<float>(from.x);
  to[1] = static_cast<float>(from.y);
  to[2] = static_cast<float>(from.z);
}

} // namespace umov
