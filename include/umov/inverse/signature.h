#pragma once
// Light of an object over all pairs of directions, small enough that a thousand objects are looked
// up at once: docs/theory/inverse.md, section 10.

#include <cstdint>
#include <span>
#include <string>
#include <umov/inverse/curve_model.h>
#include <vector>

namespace umov {

/// I and Q/I of every pair of (cells + 1)^2 directions, Sun and observer, each pair once: swapped
/// they give the same light (reciprocity). Views what a library or a `PackedLight` holds.
struct Signature {
  std::string name;
  std::size_t cells = 0, bands = 0;
  /// I = exp(ln_least + ln_step (code - 1)) [m2/sr]; code 0: no light.
  double ln_least = 0, ln_step = 0;
  /// How far I between the nodes is off, in parts of I: two of three poses are better.
  double error = 0;
  std::span<const std::uint16_t> code; ///< [(pair * bands + band) * 2]: I, then 32768 + 32767 Q/I
};

/// What a signature can say: |ln I| of its codes stays below the first (I in m2/sr from 2e-35 to
/// 5e34: what a float holds, with room), and an error is said up to the second.
inline constexpr double signature_ln_widest = 80, signature_error_most = 1e12;

/// Codes of light with their scale.
struct PackedLight {
  double ln_least = 0, ln_step = 0;
  std::vector<std::uint16_t> code;
};

/// Pairs of a grid: 97,461 for 20 cells a side (9 deg).
std::size_t signature_pairs(std::size_t cells);
/// Pairs [begin, end) as poses: any part of them can be lit by itself.
std::vector<Pose> signature_poses(std::size_t cells, std::size_t begin, std::size_t end,
                                  double sun_radius_rad);
/// Light of all pairs, in their order, as codes: I to 1 part in 5,000 over nine decades below the
/// brightest, Q/I to 1.5e-5. Light that is all fainter than the codes reach is no light.
PackedLight pack_light(const StokesTable &light);
/// Looks up, linear between the nodes; U and V are 0. `signature` and its codes must outlive it.
PoseLighting lighting_of(const Signature &signature, unsigned threads);
/// Signature::error, from poses between the nodes (of a seed) and their true light: the relative
/// error that two of three do not exceed, signature_error_most at most. Zero or less if `light` was
/// stopped.
double interpolation_error(const Signature &signature, const PoseLighting &light,
                           std::uint64_t seed);

} // namespace umov
