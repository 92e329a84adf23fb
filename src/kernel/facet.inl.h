// The light of one facet: the microfacet lobe under a Sun with a size, and diffuse products.
// docs/theory/engine.md. R is a lane type, T the scalar that constants are stored in.
#if defined(UMOV_KERNEL_FACET_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_FACET_INL_H
#undef UMOV_KERNEL_FACET_INL_H
#else
#define UMOV_KERNEL_FACET_INL_H
#endif

#include "kernel/disk_lobe.inl.h"
#include "kernel/facet_constants.h"
#include "kernel/microfacet.inl.h"

#include "kernel/begin.h"

/// 1 - n.h as |n - h|^2 / 2, which keeps in single precision what the rounding of n.h would cost:
/// 6e-8 m.
template <class R, class T>
UMOV_KERNEL R apart_from_half(const FacetPose<T> &pose, R nx, R ny, R nz) {
  const R dx = nx - R(pose.half[0]), dy = ny - R(pose.half[1]), dz = nz - R(pose.half[2]);
  return (dx * dx + dy * dy + dz * dz) * R(T(0.5));
}

/// The normal of a facet that faces both directions against the half vector.
template <class R, class T>
UMOV_KERNEL FromHalf<R> from_half(const FacetPose<T> &pose, R apart, R n_l, R n_v) {
  const R x = (n_l - n_v) * R(pose.along_scale) - R(pose.half_shift) * (R(T(1)) - apart);
  const R x2 = x * x;
  return {apart, x, x2, max(R(T(0)), apart * (R(T(2)) - apart) - x2)};
}

/// Mean of D over the half vectors of the source.
template <class R, class T>
UMOV_KERNEL R lobe_density(const LobeConstants<T> &lobe, const LobeAtPose<T> &at,
                           const FacetPose<T> &pose, const FromHalf<R> &from) {
  if (lobe.kind == LobeKind::Ggx)
    return ggx_over_disk(lobe, at, from, R(pose.half_shift));
  if (at.uses_chords)
    return narrow_over_disk(lobe, at, from, R(pose.half_shift));
  if (lobe.kind == LobeKind::Beckmann)
    return beckmann_over_disk(at, from);
  return blinn_phong_over_disk(lobe, at, from, log2_of_one_minus(from.apart));
}

/// P(k) of one direction above the horizon.
template <class R, class T> UMOV_KERNEL R lobe_masking(const LobeConstants<T> &lobe, R n_k) {
  if (lobe.kind == LobeKind::Ggx)
    return ggx_masking(min(n_k, R(T(1))), R(lobe.shape));
  const R t = min(n_k, R(lobe.masking_limit)) * R(lobe.masking_scale) - R(T(1));
  return min(R(T(1)), n_k * polynomial(lobe.masking, polynomial_degree, t));
}

/// G2 of a facet that faces both directions.
template <class R, class T>
UMOV_KERNEL R lobe_shadowing(const LobeConstants<T> &lobe, const FacetPose<T> &pose, R n_l, R n_v) {
  return joint_masking(lobe.joint, lobe_masking(lobe, n_l), lobe_masking(lobe, n_v), n_l, n_v,
                       R(pose.cos_phase));
}

/// w (n.l)(n.v) = D G2/4 [1/sr] of a facet that faces both directions; `apart`: 1 - n.h.
template <class R, class T>
UMOV_KERNEL R lobe_weight(const LobeConstants<T> &lobe, const LobeAtPose<T> &at,
                          const FacetPose<T> &pose, R apart, R n_l, R n_v) {
  const R g = lobe_shadowing(lobe, pose, n_l, n_v);
  return lobe_density(lobe, at, pose, from_half(pose, apart, n_l, n_v)) * g * R(T(0.25));
}

#include "kernel/end.h"
#endif
