#pragma once
// Does a compiled material obey the laws that every surface must obey?

#include <cstdint>
#include <umov/surface/surface.h>

namespace umov {

/// Worst cases over random geometries and all bands.
struct SurfaceAudit {
  double reciprocity = 0;       ///< |M(v->l) - Delta M^T Delta| over M00
  double cloude_min = 0;        ///< smallest Cloude eigenvalue over M00 (>= -1e-9 wanted)
  double albedo_max = 0;        ///< directional albedo (<= 1 + 1e-4 wanted)
  double energy_gap = 0;        ///< |integral of the diffuse light - what the model promises|
  double polarization_max = 0;  ///< largest p of reflected sunlight
  bool promises_energy = false; ///< the model says what its diffuse lobes send out
  /// All numbers are within what is wanted of them.
  [[nodiscard]] bool is_fine() const;
};

/// `geometries` uniform pairs of directions from the stream of `seed`, per band.
SurfaceAudit audit_surface(const Surface &surface, std::uint64_t geometries, std::uint64_t seed);

} // namespace umov
