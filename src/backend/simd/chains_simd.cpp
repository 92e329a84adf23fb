// Chains of light between surfaces for each instruction set, chosen when the program runs.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backend/simd/chains_simd.cpp"
#include <hwy/foreach_target.h>
// foreach_target comes first: it includes this file once for each instruction set.
#include "backend/simd/chain_axes.inl.h"

#include <algorithm>
#include <cstring>

#include "kernel/begin.h"

/// 16 bits of each of the three directions around one.
struct ThreeWords {
  std::uint32_t word[3];
  /// Interpolated between the three, for the lanes from s on.
  [[nodiscard]] HWY_INLINE Lanes share(const backend::GridLook &look, std::size_t s) const {
    const FloatTag d;
    Lanes sum(0.0f);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t bits = word[k] >> s;
      const auto mask = hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t *>(&bits));
      sum = sum + Lanes(hn::IfThenElseZero(mask, hn::Set(d, look.weight[k])));
    }
    return sum;
  }
};

using EndAxes = ChainEndAxes<Lanes>;
HWY_INLINE EndAxes load_end(const backend::ChainEnds &of, std::size_t s) {
  return {load_axes(of.normal, s), load_axes(of.along, s), load_axes(of.axis, s)};
}

/// The blocks of one run for one pose. Their sums are added up in floats, by lanes, until the loop
/// is `done`.
class ChainLoop {
public:
  HWY_INLINE ChainLoop(const backend::ChainData &data, const backend::ChainRun &run,
                       std::size_t band, const backend::ChainPose &pose, backend::ChainSums &out)
      : data_(data), run_(run), band_(band),
        bands_(data.bands - band < backend::chain_bands_max ? data.bands - band
                                                            : backend::chain_bands_max),
        pose_(pose), out_(out),
        axes_(pose_axes(everywhere(pose.sun), everywhere(pose.observer), everywhere(pose.plane))),
        emits_p_(emits(run.kind_p)), emits_q_(emits(run.kind_q)) {}

  HWY_INLINE void add(std::size_t begin, std::size_t count) {
    std::memset(light_, 0, bands_ * sizeof(light_[0]));
    std::memset(squares_, 0, sizeof(squares_));
    for (std::size_t k = begin; k < begin + count; k += backend::chain_blocks_together)
      add_some(k, std::min(backend::chain_blocks_together, begin + count - k));
    done();
  }

private:
  using Bits = std::uint16_t[backend::chain_blocks_together];
  /// Lanes of each block for which some direction around one is free.
  HWY_INLINE void gather(const backend::View<const std::uint16_t> &from,
                         const backend::GridLook &look, std::size_t first, std::size_t count,
                         Bits &out) const {
    const std::uint16_t *rows[3];
    for (std::size_t k = 0; k < 3; ++k)
      rows[k] = &from[look.direction[k] * data_.masks.blocks + first];
    for (std::size_t k = 0; k < count; ++k)
      out[k] = static_cast<std::uint16_t>(rows[0][k] | rows[1][k] | rows[2][k]);
  }

  HWY_INLINE void add_some(std::size_t begin, std::size_t count) {
    Bits lit_p_any, lit_q_any, seen_p_any, seen_q_any;
    gather(data_.masks.p, pose_.at_sun, run_.first + begin, count, lit_p_any);
    gather(data_.masks.q, pose_.at_sun, run_.first + begin, count, lit_q_any);
    gather(data_.masks.p, pose_.at_observer, run_.first + begin, count, seen_p_any);
    gather(data_.masks.q, pose_.at_observer, run_.first + begin, count, seen_q_any);
    for (std::size_t n = 0; n < count; ++n) {
      const bool is_open = (lit_q_any[n] & seen_p_any[n]) != 0,
                 is_open_behind = (lit_p_any[n] & seen_q_any[n]) != 0;
      if (!is_open && !is_open_behind)
        continue;
      const std::size_t k = begin + n, block = run_.first + k;
      is_noted_ = false;
      if (is_open)
        add_block<false>(k, block, words(data_.masks.p, pose_.at_observer, block),
                         words(data_.masks.q, pose_.at_sun, block));
      if (is_open_behind)
        add_block<true>(k, block, words(data_.masks.q, pose_.at_observer, block),
                        words(data_.masks.p, pose_.at_sun, block));
      if (is_noted_)
        backend::keep_note(note_, out_);
    }
  }
  HWY_INLINE ThreeWords words(const backend::View<const std::uint16_t> &from,
                              const backend::GridLook &look, std::size_t block) const {
    ThreeWords out;
    for (std::size_t k = 0; k < 3; ++k)
      out.word[k] = from[look.direction[k] * data_.masks.blocks + block];
    return out;
  }
  [[nodiscard]] HWY_INLINE const backend::ChainSurface &surface(std::uint32_t kind,
                                                                std::size_t b) const {
    return data_.surfaces[kind * data_.bands + band_ + b];
  }

  /// In some band there is other light than a lobe's.
  [[nodiscard]] HWY_INLINE bool emits(std::uint32_t kind) const {
    for (std::size_t b = 0; b < bands_; ++b)
      if (surface(kind, b).products > 0)
        return true;
    return false;
  }

  /// With the observer at one end: at q if the chains are taken from behind.
  template <bool is_reversed>
  HWY_INLINE void add_block(std::size_t k, std::size_t block, const ThreeWords &seen,
                            const ThreeWords &lit) {
    const FloatTag d;
    const backend::ChainBlock &at = data_.blocks[block];
    for (std::size_t s = 0; s < backend::lanes; s += hn::Lanes(d)) {
      const EndAxes a = load_end(is_reversed ? at.q : at.p, s),
                    b = load_end(is_reversed ? at.p : at.q, s);
      const auto end_a = chain_end_at(a.normal, a.along, axes_.observer),
                 end_b = chain_end_at(b.normal, b.along, axes_.sun);
      const Lanes whole(hn::Load(d, (is_reversed ? at.from_q : at.from_p) + s));
      const Lanes share = seen.share(pose_.at_observer, s) * lit.share(pose_.at_sun, s);
      Lanes weight = whole * share;
      const LaneMask counts =
          (end_a.n_e > Lanes(0.0f)) & (end_b.n_e > Lanes(0.0f)) & (weight > Lanes(0.0f));
      if (!any(counts))
        continue;
      weight = select(counts, weight, Lanes(0.0f));
      // Of something that is free with chance `share`; weights of three that agree add up to 1.
      const Lanes doubt = whole * sqrt(max(share * (Lanes(0.99999f) - share), Lanes(0.0f)));
      add_bands<is_reversed>(
          k, s,
          chain_at(a, b, end_a, end_b, axes_, run_.is_straight, is_reversed ? emits_q_ : emits_p_),
          weight, select(counts, doubt, Lanes(0.0f)));
    }
  }

  template <bool is_reversed>
  HWY_INLINE void add_bands(std::size_t k, std::size_t s, const ChainAt<Lanes> &at, Lanes weight,
                            Lanes doubt) {
    const std::uint32_t kind_a = is_reversed ? run_.kind_q : run_.kind_p,
                        kind_b = is_reversed ? run_.kind_p : run_.kind_q;
    Lanes lobe_a(0.0f), lobe_b(0.0f);
    for (std::size_t band = 0; band < bands_; ++band) {
      const auto &of_a = surface(kind_a, band), &of_b = surface(kind_b, band);
      if (of_a.has_lobe && (band == 0 || !of_a.is_lobe_of_first))
        lobe_a = chain_lobe(of_a.lobe, at.seen);
      if (of_b.has_lobe && (band == 0 || !of_b.is_lobe_of_first))
        lobe_b = chain_lobe(of_b.lobe, at.lit);
      const auto pass = [&](const LinearBeam<Lanes> &light) HWY_ATTR {
        return run_.is_straight ? turned(light, at.straight)
                                : between<is_reversed>(k, band, s, light);
      };
      const auto light = chain_carried(of_a, of_b, lobe_a, lobe_b, at, run_.is_without_lobes, pass);
      put(band, s, light, weight);
      if (band_ + band == 0 && !out_.notes.empty())
        note(run_.first + k, s, light.i * doubt, light.i * weight);
    }
  }

  template <bool is_reversed>
  HWY_INLINE Beam<Lanes> between(std::size_t k, std::size_t band, std::size_t s,
                                 const LinearBeam<Lanes> &light) const {
    const FloatTag d;
    const backend::ChainMatrix &m = data_.matrices[run_.matrix + k * data_.bands + band_ + band];
    const auto entry = [&](std::size_t row, std::size_t column)
                           HWY_ATTR { return Lanes(hn::Load(d, m.m[4 * row + column] + s)); };
    return chain_between(entry, is_reversed, light);
  }

  static HWY_INLINE void add_to(float *to, Lanes x) {
    const FloatTag d;
    hn::StoreU((Lanes(hn::LoadU(d, to)) + x).v, d, to);
  }
  HWY_INLINE void note(std::size_t block, std::size_t s, Lanes doubt, Lanes carried) {
    if (!is_noted_) {
      note_ = {};
      note_.block = static_cast<std::uint32_t>(block);
      is_noted_ = true;
    }
    add_to(note_.doubt + s, doubt);
    add_to(note_.carried + s, carried);
  }
  HWY_INLINE void put(std::size_t band, std::size_t s, const Beam<Lanes> &light, Lanes weight) {
    const Lanes i = light.i * weight;
    is_any_ = true;
    add_to(light_[band][0] + s, i);
    add_to(light_[band][1] + s, light.q * weight);
    add_to(light_[band][2] + s, light.u * weight);
    add_to(light_[band][3] + s, light.v * weight);
    if (band_ + band == 0)
      add_to(squares_ + s, i * i);
  }
  HWY_INLINE void done() {
    if (!is_any_)
      return;
    for (std::size_t band = 0; band < bands_; ++band) {
      backend::ChainLight &to = out_.bands[band_ + band];
      double *const part[4] = {to.i, to.q, to.u, to.v};
      for (std::size_t p = 0; p < 4; ++p)
        for (std::size_t k = 0; k < backend::lanes; ++k)
          part[p][k] += static_cast<double>(light_[band][p][k]);
    }
    for (const float one : squares_)
      out_.squares += static_cast<double>(one);
  }

  const backend::ChainData &data_;
  const backend::ChainRun &run_;
  std::size_t band_, bands_;
  const backend::ChainPose &pose_;
  backend::ChainSums &out_;
  PoseAxes<Lanes> axes_;
  bool emits_p_, emits_q_;
  HWY_ALIGN float light_[backend::chain_bands_max][4][backend::lanes];
  HWY_ALIGN float squares_[backend::lanes];
  backend::ChainNote note_;
  bool is_any_ = false, is_noted_ = false;
};

HWY_FLATTEN void sum_chains_here(const backend::ChainData &data, const backend::ChainRun &run,
                                 std::size_t begin, std::size_t blocks, std::size_t band,
                                 const backend::ChainPose &pose, backend::ChainSums &out) {
  ChainLoop(data, run, band, pose, out).add(begin, blocks);
}

#include "kernel/end.h"

#if HWY_ONCE
namespace umov::kernel {
HWY_EXPORT(sum_chains_here);
} // namespace umov::kernel

namespace umov::backend {

void sum_chains(const ChainData &data, const ChainRun &run, std::size_t begin, std::size_t blocks,
                std::size_t band, const ChainPose &pose, ChainSums &out) {
  using namespace kernel; // the table of HWY_EXPORT stands there
  HWY_DYNAMIC_DISPATCH(sum_chains_here)(data, run, begin, blocks, band, pose, out);
}

} // namespace umov::backend
#endif
