#pragma once
// Microfacets: distribution of normals and the joint masking of two directions.

#include "kernel/math.inl.h"
#include <numbers>

namespace umov::kernel {

/// Blinn-Phong D: facet area per macroscopic area and solid angle, (m+2)/(2 pi) (n.h)^m, normalised
/// with the projected area (Walter et al. 2007). n_h in [0, 1], m >= 0.
template <class R> inline R blinn_phong(R n_h, R m) {
  return (m + R(2)) / R(2 * std::numbers::pi) * power(n_h, m);
}

/// <n.h> of the paper's density (Eq. 11): (m+1)/(m+2).
template <class R> inline R mean_cosine(R m) { return (m + R(1)) / (m + R(2)); }

/// Independent masking: P(l) P(v).
template <class R> inline R separable(R p_l, R p_v) { return p_l * p_v; }

/// Ashikhmin, Premoze & Shirley 2000, Eq. 14 of the paper: (1-t) P(l)P(v) + t min, t = cos(phi/2).
template <class R> inline R ashikhmin(R p_l, R p_v, R cos_phi) {
  const R t = std::sqrt(std::max(R(0), (R(1) + cos_phi) / R(2)));
  return (R(1) - t) * p_l * p_v + t * std::min(p_l, p_v);
}

/// Height-correlated Smith, 1/(1 + L_l + L_v) with L = 1/P - 1 (Ross et al. 2005; Heitz 2014,
/// section 6), written with P so that P = 0 gives 0.
template <class R> inline R smith(R p_l, R p_v) {
  const R sum = p_l + p_v - p_l * p_v;
  return select(sum > R(0), p_l * p_v / std::max(sum, R(1e-37)), R(0));
}

/// Height and direction correlated Smith, 1/(1 + max L + x min L), x = 4.41 phi/(4.41 phi + 1)
/// (van Ginneken et al. 1998; Heitz 2014). Both sides are multiplied by P(l)P(v).
template <class R> inline R smith_directional(R p_l, R p_v, R cos_phi) {
  const R phi = std::acos(clamped(cos_phi, R(-1), R(1)));
  const R x = R(4.41) * phi / (R(4.41) * phi + R(1));
  const R low = std::min(p_l, p_v), high = std::max(p_l, p_v);
  // 1 + (1/low - 1) + x (1/high - 1) = (high + x low (1 - high)) / (low high)
  const R sum = high + x * low * (R(1) - high);
  return select(sum > R(0), low * high / std::max(sum, R(1e-37)), R(0));
}

/// Cosine of the azimuth between the projections of two directions on the surface, 1 where one of
/// them is the normal (the masking of that direction is 1 there, so the value does not matter).
template <class R> inline R cos_azimuth(R n_l, R n_v, R l_v) {
  const R s = (R(1) - n_l * n_l) * (R(1) - n_v * n_v);
  const R tiny = R(1e-30);
  return select(s > tiny, clamped((l_v - n_l * n_v) / std::sqrt(std::max(s, tiny)), R(-1), R(1)),
                R(1));
}

/// n.h from the three cosines; 0 where h is undefined (phase 180).
template <class R> inline R half_cosine(R n_l, R n_v, R l_v) {
  const R s = R(2) + R(2) * l_v;
  const R tiny = R(1e-30);
  return select(s > tiny, clamped((n_l + n_v) / std::sqrt(std::max(s, tiny)), R(0), R(1)), R(0));
}

} // namespace umov::kernel
