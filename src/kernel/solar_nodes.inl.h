// The source's disk in half-vector space.
#if defined(UMOV_KERNEL_SOLAR_NODES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_SOLAR_NODES_INL_H
#undef UMOV_KERNEL_SOLAR_NODES_INL_H
#else
#define UMOV_KERNEL_SOLAR_NODES_INL_H
#endif

#include "kernel/facet_constants.h"
#include "kernel/math.inl.h"

#include "kernel/begin.h"

/// Weight of a half vector of the disk: its centre comes first.
template <class R> UMOV_KERNEL R source_node_weight(std::size_t node) {
  return node == 0 ? R(0.25) : R(0.125);
}

/// Per-axis variances of the image of a uniform disk: halved in angle by the half vector; across
/// the scattering plane the image is longer by 1/cos(phase/2) (lobes.md, Eq. 4).
template <class R> struct DiskVariances { R along, across; };
template <class R> UMOV_KERNEL DiskVariances<R> disk_variances(R radius, R l_v) {
  const R along = radius * radius / R(16);
  return {along, along / max((R(1) + l_v) / R(2), R(1e-6))};
}

/// A direction of the disk around l, at the share `r` of its radius and an azimuth from e1 towards
/// e2; V is any vector with + and products with numbers.
template <class V, class R>
UMOV_KERNEL V disk_direction(V l, V e1, V e2, R sine_radius, R r, R cos_azimuth, R sin_azimuth) {
  const R s = r * sine_radius, c = sqrt(R(1) - s * s);
  return c * l + (s * cos_azimuth) * e1 + (s * sin_azimuth) * e2;
}

#include "kernel/end.h"
#endif
