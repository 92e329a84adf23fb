// How the loops over facets load, pack, count and add up in the lanes of an instruction set.
#if defined(UMOV_BACKEND_SIMD_MACHINE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_BACKEND_SIMD_MACHINE_INL_H
#undef UMOV_BACKEND_SIMD_MACHINE_INL_H
#else
#define UMOV_BACKEND_SIMD_MACHINE_INL_H
#endif

#include "backend/simd/lanes.inl.h"
#include "backend/simd/packer.inl.h"

#include "backend/facet_loops.inl.h"

#include "kernel/begin.h"

struct SimdMachine {
  using R = Lanes;
  using T = float;
  using S = double;
  using Mask = LaneMask;
  using Packer = kernel::HWY_NAMESPACE::Packer;
  static constexpr std::size_t width = hn::MaxLanes(FloatTag());
  static constexpr std::size_t groups_per_chunk = backend::groups_per_chunk;
  static HWY_INLINE Lanes load(const float *p) { return hn::Load(FloatTag(), p); }
  static HWY_INLINE Lanes load_any(const float *p) { return hn::LoadU(FloatTag(), p); }
  static HWY_INLINE void store_any(Lanes x, float *p) { hn::StoreU(x.v, FloatTag(), p); }
  static HWY_INLINE double total(Lanes x) {
    return static_cast<double>(hn::GetLane(hn::SumOfLanes(FloatTag(), x.v)));
  }
  static HWY_INLINE bool any(LaneMask m) { return kernel::HWY_NAMESPACE::any(m); }
  static HWY_INLINE void prefetch(const backend::MaskBlock *block) { __builtin_prefetch(block); }
  /// Words that are equal to one in three rows.
  static HWY_INLINE LaneMask all_three(const std::uint32_t *a, const std::uint32_t *b,
                                       const std::uint32_t *c, std::uint32_t value) {
    const WordTag d;
    const auto wanted = hn::Set(d, value);
    const auto differ =
        hn::Or(hn::Or(hn::Xor(hn::LoadU(d, a), wanted), hn::Xor(hn::LoadU(d, b), wanted)),
               hn::Xor(hn::LoadU(d, c), wanted));
    return {hn::RebindMask(FloatTag(), hn::Eq(differ, hn::Zero(d)))};
  }
  static HWY_INLINE std::uint32_t bits(LaneMask m) { return bits_of(m); }
  static HWY_INLINE std::uint32_t first_bit(std::uint32_t bits) {
    return static_cast<std::uint32_t>(std::countr_zero(bits));
  }

  static HWY_INLINE hn::Vec<WordTag> word(const EntryLook &look, std::size_t k, std::size_t block,
                                          std::size_t s) {
    return hn::Load(WordTag(), look.block[k][block].word + s);
  }

  /// Counts of A directions around the Sun with B around the observer, weighted.
  template <std::size_t A, std::size_t B>
  static HWY_INLINE void count_lanes(const EntryLook &sun, const EntryLook &seen, std::size_t words,
                                     std::size_t s, const float *weight, Lanes &mean,
                                     Lanes &square) {
    const WordTag du;
    hn::Vec<WordTag> count[A * B];
    for (auto &c : count)
      c = hn::Zero(du);
    for (std::size_t w = 0; w < words; ++w) {
      hn::Vec<WordTag> l[A];
      for (std::size_t a = 0; a < A; ++a)
        l[a] = word(sun, a, w, s);
      for (std::size_t b = 0; b < B; ++b) {
        const auto v = word(seen, b, w, s);
        for (std::size_t a = 0; a < A; ++a)
          count[a * B + b] = hn::Add(count[a * B + b], hn::PopulationCount(hn::And(l[a], v)));
      }
    }
    mean = square = Lanes(0.0f);
    for (std::size_t k = 0; k < A * B; ++k) {
      const Lanes c = hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), count[k]));
      const Lanes weighted = c * Lanes(weight[k]);
      mean = mean + weighted;
      square = square + weighted * c;
    }
  }

  static HWY_INLINE void count_long(const EntryLook &sun, const EntryLook &seen, std::size_t words,
                                    float *out) {
    const WordTag du;
    hn::Vec<WordTag> count[9];
    for (auto &c : count)
      c = hn::Zero(du);
    for (std::size_t block = 0; block < words / backend::lanes; ++block)
      for (std::size_t s = 0; s < backend::lanes; s += width) {
        const auto l0 = word(sun, 0, block, s), l1 = word(sun, 1, block, s),
                   l2 = word(sun, 2, block, s);
        for (std::size_t b = 0; b < 3; ++b) {
          const auto v = word(seen, b, block, s);
          count[b] = hn::Add(count[b], hn::PopulationCount(hn::And(l0, v)));
          count[3 + b] = hn::Add(count[3 + b], hn::PopulationCount(hn::And(l1, v)));
          count[6 + b] = hn::Add(count[6 + b], hn::PopulationCount(hn::And(l2, v)));
        }
      }
    for (std::size_t k = 0; k < 9; ++k)
      out[k] = hn::GetLane(
          hn::SumOfLanes(FloatTag(), hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), count[k]))));
  }
};

#include "kernel/end.h"
#endif
