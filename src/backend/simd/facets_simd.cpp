// The facet loops for each instruction set of the processor family, chosen when the program runs.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backend/simd/facets_simd.cpp"
#include <bit>
#include <hwy/foreach_target.h>
// foreach_target comes first: it includes this file once for each instruction set.
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

void sum_facets_here(const SceneData<float> &scene, const Masks *masks, const MaskErrorModel &model,
                     const PoseData<float> &pose, backend::PoseSums &out) {
  FacetLoops<SimdMachine>(scene, masks, model, pose, out).run();
}

void list_weighed_here(const SceneData<float> &scene, const Masks *masks,
                       const MaskErrorModel &model, const PoseData<float> &pose,
                       backend::WeighedList &out) {
  backend::PoseSums unused;
  FacetLoops<SimdMachine>(scene, masks, model, pose, unused).list_weighed(out);
}

#include "kernel/end.h"

#if HWY_ONCE
#include <hwy/targets.h>

namespace umov::kernel {
HWY_EXPORT(sum_facets_here);
HWY_EXPORT(list_weighed_here);
} // namespace umov::kernel

namespace umov::backend {

void sum_facets(const SceneData<float> &scene, const Masks *masks, const MaskErrorModel &model,
                const PoseData<float> &pose, backend::PoseSums &out) {
  using namespace kernel; // the table of HWY_EXPORT stands there
  HWY_DYNAMIC_DISPATCH(sum_facets_here)(scene, masks, model, pose, out);
}

void list_weighed(const SceneData<float> &scene, const Masks *masks, const MaskErrorModel &model,
                  const PoseData<float> &pose, WeighedList &out) {
  using namespace kernel;
  HWY_DYNAMIC_DISPATCH(list_weighed_here)(scene, masks, model, pose, out);
}

bool choose_instruction_set(InstructionSet set) {
  const auto of = [](InstructionSet which) -> std::int64_t {
    switch (which) {
    case InstructionSet::Baseline:
      return HWY_STATIC_TARGET;
    case InstructionSet::Sse4:
      return HWY_SSE4;
    case InstructionSet::Avx2:
      return HWY_AVX2;
    case InstructionSet::Avx512:
      return HWY_AVX3 | HWY_AVX3_DL;
    case InstructionSet::Best:
      break;
    }
    return 0;
  };
  hwy::SetSupportedTargetsForTest(0); // all that the machine has
  const std::int64_t wanted = of(set) & (hwy::SupportedTargets() | HWY_STATIC_TARGET);
  if (set != InstructionSet::Best && wanted == 0)
    return false;
  hwy::SetSupportedTargetsForTest(wanted);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return true;
}

const char *instruction_set_name() {
  const std::int64_t targets = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(targets & -targets); // the best one is the lowest bit
}

} // namespace umov::backend
#endif
