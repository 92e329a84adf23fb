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
/// From an axis to one that has these coordinates along it and along beam x axis.
template <class R> UMOV_KERNEL BeamTurn<R> turn_onto(R c, R d) {
  const R c2 = c * c, d2 = d * d, per = R(1) / max(c2 + d2, R(1e-30));
  return {(c2 - d2) * per, R(2) * c * d * per};
}
/// Light that travels along k, from axes s to axes t.
template <class R> UMOV_KERNEL BeamTurn<R> beam_turn(Triple<R> s, Triple<R> t, Triple<R> k) {
  return turn_onto(inner(t, s), inner(t, outer(k, s)));
}
template <class R> UMOV_KERNEL Beam<R> turned(Beam<R> a, BeamTurn<R> by) {
  return {a.i, a.q * by.cosine + a.u * by.sine, a.u * by.cosine - a.q * by.sine, a.v};
}

/// One end of a chain and a direction outside: what does not depend on the band.
template <class R> struct ChainEndAt {
  R n_e, n_w, e_w;  ///< cosines: outside, chain, between both
  R half, per_half; ///< of incidence on the facet, and one over it
};
template <class R>
UMOV_KERNEL ChainEndAt<R> chain_end_at(Triple<R> normal, Triple<R> along, Triple<R> outside) {
  const R e_w = max(inner(along, outside), R(-1)), half2 = max(R(0.5) + R(0.5) * e_w, R(1e-12)),
          per_half = inverse_sqrt(half2);
  return {inner(normal, outside), inner(normal, along), e_w, half2 * per_half, per_half};
}

/// sqrt(n^2 + alpha^2 (1 - n^2)): Smith's masking of GGX is 2 n/(n + this).
template <class R> UMOV_KERNEL R ggx_root(R n_k, R alpha2) {
  const R n2 = n_k * n_k;
  return sqrt(n2 + alpha2 * (R(1) - n2));
}
/// D G2 / (4 n.w) of GGX, where masking is separable or Smith's, over one fraction: divisions and
/// the masking of either direction by itself take as long as all the rest.
template <class R>
UMOV_KERNEL R ggx_chain_lobe(R sine2, R cosine2, R alpha, R n_e, R n_w, bool is_smith) {
  const R alpha2 = alpha * alpha, f = sine2 + alpha2 * cosine2;
  const R root_e = ggx_root(n_e, alpha2), root_w = ggx_root(n_w, alpha2);
  const R masked =
      is_smith ? R(2) * (n_w * root_e + n_e * root_w) : (n_e + root_e) * (n_w + root_w);
  return alpha2 * n_e / (R(std::numbers::pi) * f * f * masked);
}

/// f (n.e) over the reflection of a facet: D G2 / (4 n.w).
template <class R, class T>
UMOV_KERNEL R chain_lobe(const LobeConstants<T> &lobe, const ChainEndAt<R> &at) {
  const R n_e = max(at.n_e, R(1e-6)), n_w = max(at.n_w, R(1e-6));
  const R n_h = min((n_e + n_w) * R(0.5) * at.per_half, R(1));
  const R apart = R(1) - n_h, sine2 = apart * (R(1) + n_h), cosine2 = n_h * n_h;
  const bool is_smith = lobe.joint == Shadowing::Smith;
  if (lobe.kind == LobeKind::Ggx && (is_smith || lobe.joint == Shadowing::Separable))
    return ggx_chain_lobe(sine2, cosine2, R(lobe.shape), n_e, n_w, is_smith);
  const R density = lobe.kind == LobeKind::Ggx ? ggx(sine2, cosine2, R(lobe.shape))
                    : lobe.kind == LobeKind::Beckmann
                        ? beckmann(sine2, max(cosine2, R(1e-12)), R(lobe.shape))
                        : R(lobe.peak) * exp2(R(lobe.shape) * log2_of_one_minus(apart));
  const R g =
      joint_masking(lobe.joint, lobe_masking(lobe, n_e), lobe_masking(lobe, n_w), n_e, n_w, at.e_w);
  return density * g * R(0.25) / n_w;
}

/// Of a direction behind the surface, which other lanes may not be behind, as of one along it:
/// there is a pole there, and what is no number does not go away by a weight of 0.
template <class R> UMOV_KERNEL R bent(R cosine, float bend) {
  const R c = max(cosine, R(0));
  return R(2 * (1 + bend)) * c / (c + R(bend)) - R(1);
}
/// Of a degree that the fit of a surface chose, as few operations as the machine has for it.
template <class R> UMOV_KERNEL R bent_polynomial(const float *c, std::uint32_t degree, R t) {
  R sum = R(c[degree]);
  for (std::uint32_t k = degree; k-- > 0;)
    sum = product_and(sum, t, R(c[k]));
  return sum;
}

/// The reflection of a facet.
template <class R> struct FacetReflection { R a, b, z_real, z_imaginary; };
template <class R, class Surface>
UMOV_KERNEL FacetReflection<R> facet_reflection(const Surface &surface, R cosine) {
  const R t = bent(cosine, surface.bend);
  FacetReflection<R> out{R(surface.a[surface.degree]), R(surface.b[surface.degree]),
                         R(surface.z_real[surface.degree]), R(surface.z_imaginary[surface.degree])};
  for (std::uint32_t k = surface.degree; k-- > 0;) {
    out.a = product_and(out.a, t, R(surface.a[k]));
    out.b = product_and(out.b, t, R(surface.b[k]));
    out.z_real = product_and(out.z_real, t, R(surface.z_real[k]));
    out.z_imaginary = product_and(out.z_imaginary, t, R(surface.z_imaginary[k]));
  }
  return out;
}

/// The pose: directions, an axis across the observer's, and observer x axis.
template <class R> struct PoseAxes { Triple<R> sun, observer, plane, beside; };
template <class R>
UMOV_KERNEL PoseAxes<R> pose_axes(Triple<R> sun, Triple<R> observer, Triple<R> plane) {
  return {sun, observer, plane, outer(observer, plane)};
}

/// Turn of axes at the Sun's end, from the plane of the reflection to the axis of the chain; and at
/// the observer's, from that axis into the plane of the reflection. Of along x outside and axis, or
/// the other way round, nothing but coordinates of the direction outside is left.
template <class R>
UMOV_KERNEL BeamTurn<R> turn_at_end(Triple<R> along, Triple<R> axis, Triple<R> outside) {
  return turn_onto(inner(outside, outer(along, axis)), inner(outside, axis));
}
/// Out of the observer's end: from the plane through the observer and `from`, the chain or, for
/// what is emitted, the normal, to the pose's plane.
template <class R> UMOV_KERNEL BeamTurn<R> turn_to_pose(Triple<R> from, const PoseAxes<R> &pose) {
  return turn_onto(inner(from, pose.beside), inner(from, pose.plane));
}
/// At the observer's end: into the plane of the reflection, out to the pose's plane, and from the
/// plane of emission to that, if there is such light.
template <class R> struct TurnsAtObserver { BeamTurn<R> in, out, emitted; };
template <class R>
UMOV_KERNEL TurnsAtObserver<R> turns_at_observer(Triple<R> normal, Triple<R> along, Triple<R> axis,
                                                 const PoseAxes<R> &pose, bool emits) {
  TurnsAtObserver<R> out{turn_at_end(along, axis, pose.observer), turn_to_pose(along, pose), {}};
  out.emitted = out.out;
  if (emits)
    out.emitted = turn_to_pose(normal, pose);
  return out;
}

/// What sunlight is after its first reflection: without V.
template <class R> struct LinearBeam { R i, q, u; };
/// Of U = 0 before.
template <class R> UMOV_KERNEL LinearBeam<R> turned(R i, R q, BeamTurn<R> by) {
  return {i, q * by.cosine, -(q * by.sine)};
}
template <class R> UMOV_KERNEL Beam<R> turned(LinearBeam<R> a, BeamTurn<R> by) {
  return {a.i, a.q * by.cosine + a.u * by.sine, a.u * by.cosine - a.q * by.sine, R(0)};
}

/// Sunlight that enters a chain, in its axis: all of it, and the lobe's part.
template <class R> struct Entered { LinearBeam<R> whole, lobe; };
template <class R, class Surface>
UMOV_KERNEL Entered<R> chain_entered(const Surface &surface, R lobe, const ChainEndAt<R> &at,
                                     BeamTurn<R> turn) {
  const R nothing = R(0);
  Entered<R> out{{nothing, nothing, nothing}, {nothing, nothing, nothing}};
  FacetReflection<R> f{nothing, nothing, nothing, nothing};
  if (surface.has_lobe) {
    f = facet_reflection(surface, at.half);
    out.whole = out.lobe = turned(lobe * f.a, lobe * f.b, turn);
  }
  if (surface.products == 0)
    return out;
  R as_reflected = nothing; // light polarized as one reflection, of I = 1 before it
  for (std::uint32_t k = 0; k < surface.products; ++k) {
    const auto &p = surface.product[k];
    const R t = bent(at.n_w, p.bend), leaving = bent_polynomial(p.profile, p.degree, t);
    const R entering =
        R(p.factor) * at.n_e * bent_polynomial(p.profile, p.degree, bent(at.n_e, p.bend));
    if (p.is_as_reflected && surface.has_lobe) {
      as_reflected = as_reflected + entering * leaving;
      continue;
    }
    out.whole.i = out.whole.i + entering * leaving;
    if (p.is_polarized)
      out.whole.q = out.whole.q + entering * bent_polynomial(p.polarizing, p.degree, t);
  }
  const LinearBeam<R> more = turned(as_reflected, as_reflected / max(f.a, R(1e-12)) * f.b, turn);
  out.whole.i = out.whole.i + more.i;
  out.whole.q = out.whole.q + more.q;
  out.whole.u = out.whole.u + more.u;
  return out;
}

/// What leaves a chain to the observer of light `in` in its axis, in the pose's plane. The lobe is
/// given `to_lobe` of it: all, or what did not come from a lobe.
template <class R, class Surface>
UMOV_KERNEL Beam<R> chain_left(const Surface &surface, R lobe, const ChainEndAt<R> &at,
                               const TurnsAtObserver<R> &turns, Beam<R> in, Beam<R> to_lobe) {
  const R nothing = R(0);
  Beam<R> out{nothing, nothing, nothing, nothing}, emitted = out;
  R as_reflected = nothing;
  for (std::uint32_t k = 0; k < surface.products; ++k) {
    const auto &p = surface.product[k];
    const R t_in = bent(at.n_w, p.bend), t_out = bent(at.n_e, p.bend);
    const R leaving = R(p.factor) * at.n_e * bent_polynomial(p.profile, p.degree, t_out);
    const R entering = bent_polynomial(p.profile, p.degree, t_in);
    if (p.is_as_reflected && surface.has_lobe) {
      as_reflected = as_reflected + leaving * entering;
      continue;
    }
    R inside = entering * in.i;
    if (p.is_polarized) {
      inside = inside + bent_polynomial(p.polarizing, p.degree, t_in) * in.q;
      emitted.q = emitted.q +
                  R(p.factor) * at.n_e * bent_polynomial(p.polarizing, p.degree, t_out) * inside;
    }
    emitted.i = emitted.i + leaving * inside;
  }
  if (surface.has_lobe) {
    const auto f = facet_reflection(surface, at.half);
    Beam<R> x{lobe * to_lobe.i, lobe * to_lobe.q, lobe * to_lobe.u, lobe * to_lobe.v};
    if (surface.products > 0) {
      const R scale = as_reflected / max(f.a, R(1e-12));
      x = {x.i + scale * in.i, x.q + scale * in.q, x.u + scale * in.u, x.v + scale * in.v};
    }
    x = turned(x, turns.in);
    out =
        turned(Beam<R>{f.a * x.i + f.b * x.q, f.b * x.i + f.a * x.q,
                       f.z_real * x.u - f.z_imaginary * x.v, f.z_imaginary * x.u + f.z_real * x.v},
               turns.out);
  }
  if (surface.products == 0)
    return out;
  const LinearBeam<R> y = turned(emitted.i, emitted.q, turns.emitted);
  return {out.i + y.i, out.q + y.q, out.u + y.u, out.v};
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
/// `emits`: the seen end has light of other kinds than its lobe's.
template <class R>
UMOV_KERNEL ChainAt<R> chain_at(const ChainEndAxes<R> &seen, const ChainEndAxes<R> &lit,
                                const ChainEndAt<R> &seen_at, const ChainEndAt<R> &lit_at,
                                const PoseAxes<R> &pose, bool is_straight, bool emits) {
  ChainAt<R> out{seen_at,
                 lit_at,
                 turn_at_end(lit.along, lit.axis, pose.sun),
                 {},
                 turns_at_observer(seen.normal, seen.along, seen.axis, pose, emits)};
  out.straight = out.at_sun;
  if (is_straight)
    out.straight = beam_turn(lit.axis, seen.axis, lit.along);
  return out;
}

/// Light carried through what lies between, by the elements `entry(row, column)` of its matrix;
/// from behind by the transposed one with the signs of U, by reciprocity.
template <class R, class Entry>
UMOV_KERNEL Beam<R> chain_between(const Entry &entry, bool is_reversed, LinearBeam<R> light) {
  const R u = is_reversed ? -light.u : light.u;
  R out[4] = {light.i, light.q, u, u};
  for (std::uint32_t r = 0; r < 4; ++r)
    out[r] = is_reversed ? entry(0, r) * light.i + entry(1, r) * light.q + entry(2, r) * u
                         : entry(r, 0) * light.i + entry(r, 1) * light.q + entry(r, 2) * u;
  return {out[0], out[1], is_reversed ? -out[2] : out[2], out[3]};
}

/// The same of light that has V, too.
template <class R, class Entry>
UMOV_KERNEL Beam<R> chain_between(const Entry &entry, bool is_reversed, Beam<R> light) {
  const Beam<R> x = chain_between(entry, is_reversed, LinearBeam<R>{light.i, light.q, light.u});
  const auto more = [&](std::uint32_t r) {
    return (is_reversed ? entry(3, r) : entry(r, 3)) * light.v;
  };
  return {x.i + more(0), x.q + more(1), is_reversed ? x.u - more(2) : x.u + more(2), x.v + more(3)};
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
    to_lobe = pass(LinearBeam<R>{entered.whole.i - entered.lobe.i, entered.whole.q - entered.lobe.q,
                                 entered.whole.u - entered.lobe.u});
  return chain_left(seen, lobe_seen, at.seen, at.at_observer, in, to_lobe);
}

#include "kernel/end.h"
#endif
