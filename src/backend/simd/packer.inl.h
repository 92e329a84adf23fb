// Lanes of a register moved to its front, those of a mask.
#if defined(UMOV_BACKEND_PACKER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_BACKEND_PACKER_INL_H
#undef UMOV_BACKEND_PACKER_INL_H
#else
#define UMOV_BACKEND_PACKER_INL_H
#endif

#include "backend/simd/lanes.inl.h"
#include "backend/simd/pack_table.h"

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace umov::kernel::HWY_NAMESPACE {

HWY_INLINE std::uint32_t bits_of(LaneMask m) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(FloatTag(), m.m, bytes);
  return static_cast<std::uint32_t>(bytes[0] | bytes[1] << 8);
}

/// Whole registers are written: what is beyond `count` is of no meaning.
class Packer {
public:
  HWY_INLINE explicit Packer(LaneMask keep)
      : keep_(keep), count_(hn::CountTrue(FloatTag(), keep.m)) {
#if HWY_TARGET == HWY_AVX2
    const hn::Rebind<std::uint8_t, WordTag> d;
    from_ = hn::PromoteTo(WordTag(), hn::Load(d, backend::pack_table.lane[bits_of(keep)]));
#endif
  }
  [[nodiscard]] HWY_INLINE std::size_t count() const { return count_; }
  HWY_INLINE void put(Lanes x, float *to) const {
    const FloatTag d;
    hn::StoreU(packed(x.v), d, to);
  }
  /// `first` and so many more as the lane has before it.
  HWY_INLINE void put_indices(std::uint32_t first, std::uint32_t *to) const {
    const WordTag d; // Iota of Highway 1.0.3 writes its lanes one by one and waits for them
    hn::StoreU(packed(hn::Add(hn::Set(d, first), hn::Load(d, backend::lane_number))), d, to);
  }

private:
  template <class V> HWY_INLINE V packed(V x) const {
    const hn::DFromV<V> d;
#if HWY_TARGET == HWY_AVX2
    // Highway 1.0.3 with g++ 12 copies its table to the stack at each call.
    return hn::TableLookupLanes(x, hn::IndicesFromVec(d, from_));
#else
    return hn::Compress(x, hn::RebindMask(d, keep_.m));
#endif
  }
  LaneMask keep_;
  std::size_t count_;
#if HWY_TARGET == HWY_AVX2
  hn::Vec<WordTag> from_;
#endif
};

} // namespace umov::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
