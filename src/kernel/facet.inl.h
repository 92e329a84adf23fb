// The light of one facet: the microfacet lobe under a Sun with a size, and diffuse products.
// docs/theory/engine.md. R is a lane type, T the scalar that constants are stored in.
#if defined(UMOV_KERNEL_FACET_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_FACET_INL_H
#undef UMOV_KERNEL_FACET_INL_H
#else
#define UMOV_KERNEL_FACET_INL_H
#endif

#include "kernel/facet_constants.h"
#include "kernel/microfacet.inl.h"
#include "kernel/solar_nodes.inl.h"

#include "kernel/begin.h"

/// 1 - n.h as |n - h|^2 / 2, which keeps in single precision what the rounding of n.h would cost:
/// 6e-8 m.
template <class R, class T>
UMOV_KERNEL R one_minus_cosine(const FacetPose<T> &pose, std::size_t node, R nx, R ny, R nz) {
  const R x = nx - R(pose.half[node][0]), y = ny - R(pose.half[node][1]),
          z = nz - R(pose.half[node][2]);
  return (x * x + y * y + z * z) * R(T(0.5));
}

/// The normal against the half vector: what all Blinn-Phong lobes of a facet share.
template <class R> struct FromHalf { R log2_cosine, x2, y2; };
template <class R, class T>
UMOV_KERNEL FromHalf<R> from_half(const FacetPose<T> &pose, R nx, R ny, R nz, R n_l, R n_v) {
  const R d = one_minus_cosine(pose, 0, nx, ny, nz);
  const R x = (n_l - n_v) * R(pose.along_scale), x2 = x * x;
  return {log2_of_one_minus(d), x2, max(R(T(0)), d * (R(T(2)) - d) - x2)};
}
/// Mean of Blinn-Phong's D over the disk, in closed form.
template <class R, class T>
UMOV_KERNEL R closed_density(const LobeConstants<T> &lobe, const LobeAtPose<T> &at,
                             const FromHalf<R> &from) {
  return R(at.peak) *
         exp2(R(lobe.shape) * from.log2_cosine + R(at.along) * from.x2 + R(at.across) * from.y2);
}

/// Mean of D over the half vectors of the source.
template <class R, class T>
UMOV_KERNEL R lobe_density(const LobeConstants<T> &lobe, const LobeAtPose<T> &at,
                           const FacetPose<T> &pose, R nx, R ny, R nz, R n_l, R n_v) {
  if (at.has_closed_form)
    return closed_density(lobe, at, from_half(pose, nx, ny, nz, n_l, n_v));
  const auto density = [&](std::size_t node) {
    const R d = one_minus_cosine(pose, node, nx, ny, nz);
    if (lobe.kind == LobeKind::BlinnPhong)
      return R(lobe.peak) * exp2(R(lobe.shape) * log2_of_one_minus(d));
    const R cosine = max(R(T(1)) - d, R(T(1e-4))), sine2 = d * (R(T(2)) - d);
    if (lobe.kind == LobeKind::Beckmann)
      return beckmann(sine2, cosine * cosine, R(lobe.shape));
    return ggx(sine2, cosine * cosine, R(lobe.shape));
  };
  if (!at.uses_nodes)
    return density(0);
  R sum = density(0) * R(source_node_weight<T>(0));
  for (std::size_t k = 1; k < source_nodes; ++k)
    sum = sum + density(k) * R(source_node_weight<T>(k));
  return sum;
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

/// w (n.l)(n.v) = D G2/4 [1/sr] of a facet that faces both directions.
template <class R, class T>
UMOV_KERNEL R lobe_weight(const LobeConstants<T> &lobe, const LobeAtPose<T> &at,
                          const FacetPose<T> &pose, R nx, R ny, R nz, R n_l, R n_v) {
  const R g = lobe_shadowing(lobe, pose, n_l, n_v);
  return lobe_density(lobe, at, pose, nx, ny, nz, n_l, n_v) * g * R(T(0.25));
}

#include "kernel/end.h"
#endif
