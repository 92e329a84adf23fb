// Light at the ends of a chain between surfaces: from the Sun into it, and out of it to the
// observer. docs/theory/bounces.md, "Chains".
#if defined(UMOV_KERNEL_CHAIN_END_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_CHAIN_END_INL_H
#undef UMOV_KERNEL_CHAIN_END_INL_H
#else
#define UMOV_KERNEL_CHAIN_END_INL_H
#endif

#include "kernel/facet.inl.h"

#include "kernel/begin.h"

template <class R> struct Triple { R x, y, z; };
template <class R> UMOV_KERNEL R inner(Triple<R> a, Triple<R> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class R> UMOV_KERNEL Triple<R> outer(Triple<R> a, Triple<R> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class R> struct Beam { R i, q, u, v; };

/// Cosine and sine of twice the angle between two axes of a beam, of any lengths.
template <class R> struct BeamTurn { R cosine, sine; };
/// Light that travels along k, from axes s to axes t.
template <class R> UMOV_KERNEL BeamTurn<R> beam_turn(Triple<R> s, Triple<R> t, Triple<R> k) {
  const R c = inner(t, s), d = inner(t, outer(k, s));
  const R per = R(1) / max(c * c + d * d, R(1e-30));
  return {(c * c - d * d) * per, R(2) * c * d * per};
}
template <class R> UMOV_KERNEL Beam<R> turned(Beam<R> a, BeamTurn<R> by) {
  return {a.i, a.q * by.cosine + a.u * by.sine, a.u * by.cosine - a.q * by.sine, a.v};
}

/// One end of a chain and a direction outside: what does not depend on the band.
template <class R> struct ChainEndAt {
  R n_e, n_w, e_w; ///< cosines: outside, chain, between both
  R half;          ///< of incidence on the facet
};
template <class R>
UMOV_KERNEL ChainEndAt<R> chain_end_at(Triple<R> normal, Triple<R> along, Triple<R> outside) {
  const R e_w = max(inner(along, outside), R(-1));
  return {inner(normal, outside), inner(normal, along), e_w,
          sqrt(max(R(0.5) + R(0.5) * e_w, R(1e-12)))};
}

/// f (n.e) over the reflection of a facet: D G2 / (4 n.w).
template <class R, class T>
UMOV_KERNEL R chain_lobe(const LobeConstants<T> &lobe, const ChainEndAt<R> &at) {
  const R n_e = max(at.n_e, R(1e-6)), n_w = max(at.n_w, R(1e-6));
  const R n_h = min((n_e + n_w) * R(0.5) / at.half, R(1));
  const R apart = R(1) - n_h, sine2 = apart * (R(1) + n_h), cosine2 = n_h * n_h;
  const R density = lobe.kind == LobeKind::Ggx ? ggx(sine2, cosine2, R(lobe.shape))
                    : lobe.kind == LobeKind::Beckmann
                        ? beckmann(sine2, max(cosine2, R(1e-12)), R(lobe.shape))
                        : R(lobe.peak) * exp2(R(lobe.shape) * log2_of_one_minus(apart));
  const R g =
      joint_masking(lobe.joint, lobe_masking(lobe, n_e), lobe_masking(lobe, n_w), n_e, n_w, at.e_w);
  return density * g * R(0.25) / n_w;
}

template <class R> UMOV_KERNEL R bent(R cosine, float bend) {
  return R(2 * (1 + bend)) * cosine / (cosine + R(bend)) - R(1);
}
template <class R> UMOV_KERNEL R bent_polynomial(const float *c, R t) {
  return polynomial(c, polynomial_degree, t);
}

/// The reflection of a facet.
template <class R> struct FacetReflection { R a, b, z_real, z_imaginary; };
template <class R, class Surface>
UMOV_KERNEL FacetReflection<R> facet_reflection(const Surface &surface, R cosine) {
  const R t = bent(cosine, surface.bend);
  return {bent_polynomial(surface.a, t), bent_polynomial(surface.b, t),
          bent_polynomial(surface.z_real, t), bent_polynomial(surface.z_imaginary, t)};
}

/// Turns of axes at the Sun's end: from the plane of the reflection to the axis of the chain.
template <class R>
UMOV_KERNEL BeamTurn<R> turn_at_sun(Triple<R> along, Triple<R> axis, Triple<R> sun) {
  return beam_turn(outer(along, sun), axis, along);
}
/// At the observer's end: into the plane of the reflection, out to the pose's plane, and from the
/// plane of emission to that.
template <class R> struct TurnsAtObserver { BeamTurn<R> in, out, emitted; };
template <class R>
UMOV_KERNEL TurnsAtObserver<R> turns_at_observer(Triple<R> normal, Triple<R> along, Triple<R> axis,
                                                 Triple<R> observer, Triple<R> plane) {
  const Triple<R> s = outer(observer, along), back{-along.x, -along.y, -along.z};
  return {beam_turn(axis, s, back), beam_turn(s, plane, observer),
          beam_turn(outer(normal, observer), plane, observer)};
}

/// Sunlight that enters a chain, in its axis: all of it, and the lobe's part.
template <class R> struct Entered { Beam<R> whole, lobe; };
template <class R, class Surface>
UMOV_KERNEL Entered<R> chain_entered(const Surface &surface, R lobe, const ChainEndAt<R> &at,
                                     BeamTurn<R> turn) {
  const R nothing = R(0);
  Entered<R> out{{nothing, nothing, nothing, nothing}, {nothing, nothing, nothing, nothing}};
  R as_reflected = nothing; // light polarized as one reflection, of I = 1 before it
  FacetReflection<R> f{nothing, nothing, nothing, nothing};
  if (surface.has_lobe) {
    f = facet_reflection(surface, at.half);
    out.lobe = turned(Beam<R>{lobe * f.a, lobe * f.b, nothing, nothing}, turn);
  }
  for (std::uint32_t k = 0; k < surface.products; ++k) {
    const auto &p = surface.product[k];
    const R t = bent(at.n_w, p.bend), leaving = bent_polynomial(p.profile, t);
    const R entering = R(p.factor) * at.n_e * bent_polynomial(p.profile, bent(at.n_e, p.bend));
    if (p.is_as_reflected && surface.has_lobe) {
      as_reflected = as_reflected + entering * leaving;
      continue;
    }
    out.whole.i = out.whole.i + entering * leaving;
    if (p.is_polarized)
      out.whole.q = out.whole.q + entering * bent_polynomial(p.polarizing, t);
  }
  const R scale = as_reflected / max(f.a, R(1e-12));
  const Beam<R> more = turned(Beam<R>{as_reflected, scale * f.b, nothing, nothing}, turn);
  out.whole.i = out.whole.i + more.i + out.lobe.i;
  out.whole.q = out.whole.q + more.q + out.lobe.q;
  out.whole.u = more.u + out.lobe.u;
  return out;
}

/// What leaves a chain to the observer of light `in` in its axis, in the pose's plane. The lobe is
/// given `to_lobe` of it: all, or what did not come from a lobe.
template <class R, class Surface>
UMOV_KERNEL Beam<R> chain_left(const Surface &surface, R lobe, const ChainEndAt<R> &at,
                               const TurnsAtObserver<R> &turns, Beam<R> in, Beam<R> to_lobe) {
  const R nothing = R(0);
  Beam<R> reflected{nothing, nothing, nothing, nothing}, emitted = reflected;
  R as_reflected = nothing;
  for (std::uint32_t k = 0; k < surface.products; ++k) {
    const auto &p = surface.product[k];
    const R t_in = bent(at.n_w, p.bend), t_out = bent(at.n_e, p.bend);
    const R leaving = R(p.factor) * at.n_e * bent_polynomial(p.profile, t_out);
    const R entering = bent_polynomial(p.profile, t_in);
    if (p.is_as_reflected && surface.has_lobe) {
      as_reflected = as_reflected + leaving * entering;
      continue;
    }
    R inside = entering * in.i;
    if (p.is_polarized) {
      inside = inside + bent_polynomial(p.polarizing, t_in) * in.q;
      emitted.q = emitted.q + R(p.factor) * at.n_e * bent_polynomial(p.polarizing, t_out) * inside;
    }
    emitted.i = emitted.i + leaving * inside;
  }
  if (surface.has_lobe) {
    const auto f = facet_reflection(surface, at.half);
    const R scale = as_reflected / max(f.a, R(1e-12));
    const auto mixed = [&](R whole, R part) { return scale * whole + lobe * part; };
    const Beam<R> a = turned(in, turns.in), b = turned(to_lobe, turns.in);
    const R i = mixed(a.i, b.i), q = mixed(a.q, b.q), u = mixed(a.u, b.u), v = mixed(a.v, b.v);
    reflected = {f.a * i + f.b * q, f.b * i + f.a * q, f.z_real * u - f.z_imaginary * v,
                 f.z_imaginary * u + f.z_real * v};
  }
  const Beam<R> x = turned(reflected, turns.out), y = turned(emitted, turns.emitted);
  return {x.i + y.i, x.q + y.q, x.u + y.u, x.v};
}

/// An end as it is drawn.
template <class R> struct ChainEndAxes { Triple<R> normal, along, axis; };
/// A chain and a pose, but for the band: `at_sun` and `at_observer` turn axes as above, `straight`
/// from the lit end's to the other's where nothing lies between.
template <class R> struct ChainAt {
  ChainEndAt<R> seen, lit;
  BeamTurn<R> at_sun, straight;
  TurnsAtObserver<R> at_observer;
};
template <class R>
UMOV_KERNEL ChainAt<R> chain_at(const ChainEndAxes<R> &seen, const ChainEndAxes<R> &lit,
                                const ChainEndAt<R> &seen_at, const ChainEndAt<R> &lit_at,
                                Triple<R> sun, Triple<R> observer, Triple<R> plane) {
  return {seen_at, lit_at, turn_at_sun(lit.along, lit.axis, sun),
          beam_turn(lit.axis, seen.axis, lit.along),
          turns_at_observer(seen.normal, seen.along, seen.axis, observer, plane)};
}

/// Light carried through what lies between, by the elements `entry(row, column)` of its matrix;
/// from behind by the transposed one with the signs of U, by reciprocity.
template <class R, class Entry>
UMOV_KERNEL Beam<R> chain_between(const Entry &entry, bool is_reversed, Beam<R> light) {
  const R u = is_reversed ? -light.u : light.u;
  R out[4] = {light.i, light.q, u, light.v};
  for (std::uint32_t r = 0; r < 4; ++r)
    out[r] = is_reversed ? entry(0, r) * light.i + entry(1, r) * light.q + entry(2, r) * u +
                               entry(3, r) * light.v
                         : entry(r, 0) * light.i + entry(r, 1) * light.q + entry(r, 2) * u +
                               entry(r, 3) * light.v;
  return {out[0], out[1], is_reversed ? -out[2] : out[2], out[3]};
}

/// What a chain carries from the Sun to the observer in one band; `pass` takes a beam from the lit
/// end to the other.
template <class R, class Surface, class Pass>
UMOV_KERNEL Beam<R> chain_carried(const Surface &seen, const Surface &lit, R lobe_seen, R lobe_lit,
                                  const ChainAt<R> &at, bool is_without_lobes, const Pass &pass) {
  const Entered<R> entered = chain_entered(lit, lobe_lit, at.lit, at.at_sun);
  const Beam<R> in = pass(entered.whole);
  Beam<R> to_lobe = in;
  if (is_without_lobes)
    to_lobe = pass(Beam<R>{entered.whole.i - entered.lobe.i, entered.whole.q - entered.lobe.q,
                           entered.whole.u - entered.lobe.u, entered.whole.v});
  return chain_left(seen, lobe_seen, at.seen, at.at_observer, in, to_lobe);
}

#include "kernel/end.h"
#endif
