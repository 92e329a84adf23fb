// Vectors of chains, a component in each register.
#if defined(UMOV_BACKEND_CHAIN_AXES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_BACKEND_CHAIN_AXES_INL_H
#undef UMOV_BACKEND_CHAIN_AXES_INL_H
#else
#define UMOV_BACKEND_CHAIN_AXES_INL_H
#endif

#include "backend/simd/lanes.inl.h"

#include "backend/chain_data.h"
#include "kernel/chain_end.inl.h"

#include "kernel/begin.h"

using Axes = Triple<Lanes>;

HWY_INLINE Axes everywhere(const float *v) { return {Lanes(v[0]), Lanes(v[1]), Lanes(v[2])}; }
/// Of the chains from number s of a block on.
HWY_INLINE Axes load_axes(const float (*v)[backend::lanes], std::size_t s) {
  const FloatTag d;
  return {hn::Load(d, v[0] + s), hn::Load(d, v[1] + s), hn::Load(d, v[2] + s)};
}

#include "kernel/end.h"
#endif
