// Light that leaves a body through its smooth surface: polarized along the plane of emission.
#if defined(UMOV_KERNEL_BODY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_BODY_INL_H
#undef UMOV_KERNEL_BODY_INL_H
#else
#define UMOV_KERNEL_BODY_INL_H
#endif

#include "kernel/facet_constants.h"
#include "kernel/math.inl.h"

#include "kernel/begin.h"

/// Transmission for both polarizations as (T_s + T_p)/2 and (T_s - T_p)/2.
template <class R> struct Transmitted { R mean, half_difference; };

/// cos and sin of twice the angles from the scattering plane's s axis to the normals of the plane
/// of incidence (n, l) and of emission (n, v), each in its own beam.
template <class R> struct EmissionPlanes { R cos_in, sin_in, cos_out, sin_out; };

/// l, v: unit vectors in a frame with the surface normal along z. With s = (v x l)/|v x l| and
/// p = k x s for each beam: (n x v).s = (n_v l.v - n_l)/S, (n x v).p_out = -n.s;
/// (n x l).s = (n_v - n_l l.v)/S, (n x l).p_in = n.s, S = |v x l|. All four are 1, 0, 1, 0 where
/// there is no plane (phase 0 or 180, normal incidence or emission).
template <class R>
UMOV_KERNEL EmissionPlanes<R> emission_planes(R lx, R ly, R lz, R vx, R vy, R vz) {
  const R sx = vy * lz - vz * ly, sy = vz * lx - vx * lz, sz = vx * ly - vy * lx;
  const R size = sqrt(sx * sx + sy * sy + sz * sz);
  const R tiny = R(1e-15);
  const R scale = select(size > tiny, R(1) / max(size, tiny), R(0));
  const R l_v = lx * vx + ly * vy + lz * vz;
  const R n_s = sz * scale;
  const R out_s = (vz * l_v - lz) * scale, in_s = (vz - lz * l_v) * scale;
  const R out = out_s * out_s + n_s * n_s, in = in_s * in_s + n_s * n_s;
  const auto has_out = out > R(1e-24), has_in = in > R(1e-24);
  const R per_out = R(1) / max(out, R(1e-24)), per_in = R(1) / max(in, R(1e-24));
  return {select(has_in, (in_s * in_s - n_s * n_s) * per_in, R(1)),
          select(has_in, R(2) * in_s * n_s * per_in, R(0)),
          select(has_out, (out_s * out_s - n_s * n_s) * per_out, R(1)),
          select(has_out, R(-2) * out_s * n_s * per_out, R(0))};
}

/// cos and sin of twice the angle of the plane of emission, times 1 - (n.v)^2: without a division,
/// and 0 at the normal. `aside`: n.across.
template <class R> struct EmissionTurn { R cosine, sine; };
template <class R, class T>
UMOV_KERNEL EmissionTurn<R> emission_turn(const FacetPose<T> &pose, R aside, R n_l, R n_v) {
  const R out = (n_v * R(pose.cos_phase) - n_l) * R(pose.per_sine);
  return {out * out - aside * aside, R(T(-2)) * out * aside};
}

#include "kernel/end.h"
#endif
