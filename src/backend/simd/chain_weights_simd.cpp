// What chains would carry if nothing were in the way of their ends, for each instruction set.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backend/simd/chain_weights_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target comes first: it includes this file once for each instruction set.
#include "backend/simd/chain_axes.inl.h"

#include "kernel/begin.h"

/// f (n.e) of one end by its lobe and by the rest, n.e above 0. A polynomial that its error takes
/// below 0 must leave something: what weighs nothing is never drawn.
struct EndStrength {
  Lanes lobe, rest;
};

HWY_INLINE EndStrength strength_of(const backend::ChainSurface &surface, Lanes lobe,
                                   const ChainEndAt<Lanes> &at) {
  const Lanes nothing(0.0f), least(backend::chain_fit_error);
  EndStrength out{nothing, nothing};
  if (surface.has_lobe)
    out.lobe =
        lobe * max(bent_polynomial(surface.a, surface.degree, bent(at.half, surface.bend)), least);
  for (std::uint32_t k = 0; k < surface.products; ++k) {
    const auto &p = surface.product[k];
    out.rest =
        out.rest + Lanes(p.factor) * at.n_e *
                       max(bent_polynomial(p.profile, p.degree, bent(at.n_e, p.bend)), least) *
                       max(bent_polynomial(p.profile, p.degree, bent(at.n_w, p.bend)), least);
  }
  out.rest = max(out.rest, nothing);
  return out;
}

/// One run of chains and one pose.
struct ChainWeights {
  const backend::ChainSurface *p, *q; ///< of all bands
  std::size_t bands;
  bool is_without_lobes;
  Axes sun, observer;

  struct End {
    Axes normal, along;
    HWY_INLINE End(const backend::ChainEnds &of, std::size_t s)
        : normal(load_axes(of.normal, s)), along(load_axes(of.along, s)) {}
  };
  /// Seen at one end and lit at the other, summed over the bands.
  HWY_INLINE Lanes one_way(const backend::ChainSurface *seen, const End &at_seen,
                           const backend::ChainSurface *lit, const End &at_lit) const {
    const Lanes nothing(0.0f);
    const auto a = chain_end_at(at_seen.normal, at_seen.along, observer),
               b = chain_end_at(at_lit.normal, at_lit.along, sun);
    const LaneMask counts = (a.n_e > nothing) & (b.n_e > nothing);
    if (!any(counts))
      return nothing;
    Lanes sum = nothing, lobe_a = nothing, lobe_b = nothing;
    for (std::size_t band = 0; band < bands; ++band) {
      if (seen[band].has_lobe && (band == 0 || !seen[band].is_lobe_of_first))
        lobe_a = chain_lobe(seen[band].lobe, a);
      if (lit[band].has_lobe && (band == 0 || !lit[band].is_lobe_of_first))
        lobe_b = chain_lobe(lit[band].lobe, b);
      const EndStrength x = strength_of(seen[band], lobe_a, a),
                        y = strength_of(lit[band], lobe_b, b);
      const Lanes but_lobes = (x.lobe + x.rest) * y.rest + x.rest * y.lobe;
      sum = sum + (is_without_lobes ? but_lobes : but_lobes + x.lobe * y.lobe);
    }
    return select(counts, sum, nothing);
  }
  HWY_INLINE void put(const backend::ChainBlock &at, const float *transmitted, float *out) const {
    const FloatTag d;
    for (std::size_t s = 0; s < backend::lanes; s += hn::Lanes(d)) {
      const End end_p(at.p, s), end_q(at.q, s);
      // Weights of both ways alike, so that Sun and observer exchanged choose the same chains.
      const Lanes weight =
          Lanes(0.5f) * (Lanes(hn::Load(d, at.from_p + s)) + Lanes(hn::Load(d, at.from_q + s)));
      const Lanes ways = one_way(p, end_p, q, end_q) + one_way(q, end_q, p, end_p);
      hn::StoreU((weight * ways * Lanes(hn::LoadU(d, transmitted + s))).v, d, out + s);
    }
  }
};

void weigh_chains_here(const backend::ChainData &data, const backend::ChainRun &run,
                       std::size_t begin, std::size_t blocks, const backend::ChainPose &pose,
                       float *out) {
  const ChainWeights weights{&data.surfaces[run.kind_p * data.bands],
                             &data.surfaces[run.kind_q * data.bands],
                             data.bands,
                             run.is_without_lobes,
                             everywhere(pose.sun),
                             everywhere(pose.observer)};
  for (std::size_t k = 0; k < blocks; ++k) {
    const std::size_t block = run.first + begin + k;
    weights.put(data.blocks[block], &data.transmitted[block * backend::lanes],
                out + k * backend::lanes);
  }
}

#include "kernel/end.h"

#if HWY_ONCE
namespace umov::kernel {
HWY_EXPORT(weigh_chains_here);
} // namespace umov::kernel

namespace umov::backend {

void weigh_chains(const ChainData &data, const ChainRun &run, std::size_t begin, std::size_t blocks,
                  const ChainPose &pose, float *out) {
  using namespace kernel; // the table of HWY_EXPORT stands there
  HWY_DYNAMIC_DISPATCH(weigh_chains_here)(data, run, begin, blocks, pose, out);
}

} // namespace umov::backend
#endif
