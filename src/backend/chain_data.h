#pragma once
// Private to src/light: chains of light between surfaces as the vector unit reads them, 16 side by
// side. docs/theory/bounces.md, "Chains".

#include "backend/scene_data.h"

namespace umov::backend {

inline constexpr std::size_t chain_products_max = 3;
/// What a polynomial of a surface may miss, in parts of its largest value; and what it is wanted
/// to, by the lowest degree that does.
inline constexpr double chain_fit_error = 5e-4, chain_fit_wanted = 1e-4;

/// One product of diffuse light: factor p(n.l) p(n.v), polynomials in t = 2 (1 + bend) c/(c + bend)
/// - 1.
struct ChainProduct {
  float factor = 0, bend = 1;
  std::uint32_t degree = 0;
  bool is_as_reflected = false; ///< polarized as one reflection
  bool is_polarized = false;    ///< about the plane of emission, by `polarizing`
  float profile[kernel::polynomial_degree + 1]{};
  float polarizing[kernel::polynomial_degree + 1]{};
};

/// A surface in one band.
struct ChainSurface {
  kernel::LobeConstants<float> lobe;
  bool has_lobe = true;
  bool is_lobe_of_first = false; ///< that of the first band
  float bend = 1;                ///< of the reflection of a facet, over the cosine of incidence
  std::uint32_t degree = 0;
  float a[kernel::polynomial_degree + 1]{}, b[kernel::polynomial_degree + 1]{};
  float z_real[kernel::polynomial_degree + 1]{}, z_imaginary[kernel::polynomial_degree + 1]{};
  std::uint32_t products = 0;
  ChainProduct product[chain_products_max];
};

/// One end of 16 chains: unit vectors, components by lanes.
struct ChainEnds {
  float normal[3][lanes], along[3][lanes], axis[3][lanes];
};
/// 16 chains, one of each replicate; without weight where there is none.
struct alignas(64) ChainBlock {
  ChainEnds p, q;
  float from_p[lanes], from_q[lanes]; ///< weight with the observer at p, at q
};
/// Matrices of 16 chains in one band, by lanes.
struct alignas(64) ChainMatrix {
  float m[16][lanes];
};

/// Blocks whose ends have the same surfaces.
struct ChainRun {
  std::uint32_t first = 0, count = 0;
  std::uint32_t kind_p = 0, kind_q = 0; ///< of surface
  std::uint32_t matrix = 0; ///< first of `matrices`, bands of a block side by side; unless straight
  bool is_straight = true;
  bool is_without_lobes = false; ///< less what goes from the lobe of one end to that of the other
};

/// In which directions of a grid each end is free: [direction * blocks + block], a bit per lane.
struct ChainMasks {
  std::size_t blocks = 0;
  View<const std::uint16_t> p, q;
};

struct ChainData {
  View<const ChainBlock> blocks;
  View<const ChainMatrix> matrices;
  View<const ChainSurface> surfaces; ///< [kind * bands + band]
  ChainMasks masks;
  std::size_t bands = 0;
  View<const float> transmitted; ///< of I, [block * lanes + lane]: for weigh_chains alone
};

/// Blocks that are looked through together for those that anything lights and sees.
inline constexpr std::size_t chain_blocks_together = 64;

/// A pose as chains see it.
struct ChainPose {
  float sun[3]{}, observer[3]{}, plane[3]{}; ///< normal of the scattering plane: axis +Q
  GridLook at_sun, at_observer;
};

/// Light by lanes in one band.
struct ChainLight {
  double i[lanes]{}, q[lanes]{}, u[lanes]{}, v[lanes]{};
};
/// What one block carried to a pose, in the first band.
struct ChainNote {
  std::uint32_t block;
  /// I times the standard deviation of a guess whether its ends are free, where the grid's
  /// directions around do not agree; both ways along a chain together.
  float doubt[lanes];
  float carried[lanes];           ///< I itself
  float most_doubt, most_carried; ///< of all lanes
};
struct ChainSums {
  View<ChainLight> bands;
  double squares = 0; ///< sum of I^2 of the chains in the first band, one by one
  /// Room for a note on every block, or none if nobody will ask; those that carried have one.
  View<ChainNote> notes;
  std::size_t noted = 0;
  double doubt = 0, carried = 0; ///< sums over the notes
  /// Of chains between two fairly narrow lobes: I in the first band, and its squares.
  double narrow_i = 0, narrow_squares = 0;
};
/// The largest and the sum of 16 numbers, none below 0: four side by side.
struct LaneSummary {
  float most = 0, sum = 0;
  explicit LaneSummary(const float (&of)[lanes]) {
    constexpr std::size_t beside = 4;
    float largest[beside]{}, sums[beside]{};
    for (std::size_t k = 0; k < lanes; ++k) {
      largest[k % beside] = of[k] > largest[k % beside] ? of[k] : largest[k % beside];
      sums[k % beside] += of[k];
    }
    for (std::size_t k = 0; k < beside; ++k) {
      most = largest[k] > most ? largest[k] : most;
      sum += sums[k];
    }
  }
};
inline void keep_note(const ChainNote &note, ChainSums &sums) {
  const LaneSummary doubt(note.doubt), carried(note.carried);
  ChainNote &kept = sums.notes[sums.noted++];
  kept = note;
  kept.most_doubt = doubt.most;
  kept.most_carried = carried.most;
  sums.doubt += static_cast<double>(doubt.sum);
  sums.carried += static_cast<double>(carried.sum);
}
inline constexpr std::size_t chain_bands_max = 8; ///< more go in parts

/// Adds what the chains of some blocks of a run carry from the Sun to the observer, `blocks` of
/// them from number `begin` of the run on, in bands from `band` on, chain_bands_max at most.
void sum_chains(const ChainData &data, const ChainRun &run, std::size_t begin, std::size_t blocks,
                std::size_t band, const ChainPose &pose, ChainSums &out);

/// What each chain of some blocks of a run would carry in the mean of all bands if nothing were in
/// the way of its ends, both ways together and roughly (as of light without polarization): [block *
/// lanes + lane], 0 only where it carries nothing.
void weigh_chains(const ChainData &data, const ChainRun &run, std::size_t begin, std::size_t blocks,
                  const ChainPose &pose, float *out);

} // namespace umov::backend
