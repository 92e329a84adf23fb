#pragma once
// The machine of the facet loops that takes one facet after the other: the scalar reference, and
// one thread of a graphics processor.

#include "backend/facet_loops.inl.h"

#if !defined(__CUDACC__)
#include <bit>
#endif

namespace umov::backend {

UMOV_KERNEL int count_ones(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
  return __popc(bits);
#elif defined(__CUDACC__)
  return 0; // nvcc's host half, which nobody calls
#else
  return std::popcount(bits);
#endif
}

/// `Scalar`: what facets are computed in; `Sum`: what they are added up in; `groups`: of a chunk,
/// at most.
template <class Scalar, class Sum, std::size_t groups> struct OneFacetMachine {
  using R = Scalar;
  using T = Scalar;
  using S = Sum;
  using Mask = bool;
  static constexpr std::size_t width = 1, groups_per_chunk = groups;
  UMOV_KERNEL static T load(const T *p) { return *p; }
  UMOV_KERNEL static T load_any(const T *p) { return *p; }
  UMOV_KERNEL static void store_any(T x, T *p) { *p = x; }
  UMOV_KERNEL static T total(T x) { return x; }
  UMOV_KERNEL static bool any(bool x) { return x; }
  UMOV_KERNEL static bool all_three(const std::uint32_t *a, const std::uint32_t *b,
                                    const std::uint32_t *c, std::uint32_t value) {
    return *a == value && *b == value && *c == value;
  }
  UMOV_KERNEL static void prefetch(const MaskBlock *) {}
  UMOV_KERNEL static std::uint32_t bits(bool x) { return x ? 1 : 0; }
  UMOV_KERNEL static std::uint32_t first_bit(std::uint32_t) { return 0; }
  class Packer {
  public:
    UMOV_KERNEL explicit Packer(bool keep) : keep_(keep) {}
    [[nodiscard]] UMOV_KERNEL std::size_t count() const { return keep_ ? 1 : 0; }
    UMOV_KERNEL static void put(T x, T *to) { *to = x; }
    UMOV_KERNEL static void put_indices(std::uint32_t first, std::uint32_t *to) { *to = first; }

  private:
    bool keep_;
  };
  UMOV_KERNEL static int joint(const kernel::EntryLook &sun, const kernel::EntryLook &seen,
                               std::size_t a, std::size_t b, std::size_t block, std::size_t word) {
    return count_ones(sun.block[a][block].word[word] & seen.block[b][block].word[word]);
  }

  template <std::size_t A, std::size_t B>
  UMOV_KERNEL static void count_lanes(const kernel::EntryLook &sun, const kernel::EntryLook &seen,
                                      std::size_t words, std::size_t s, const float *weight,
                                      T &mean, T &square) {
    mean = square = 0;
    for (std::size_t k = 0; k < A * B; ++k) {
      int count = 0;
      for (std::size_t w = 0; w < words; ++w)
        count += joint(sun, seen, k / B, k % B, w, s);
      const T c = static_cast<T>(count), part = static_cast<T>(weight[k]);
      mean += part * c;
      square += part * c * c;
    }
  }
  UMOV_KERNEL static void count_long(const kernel::EntryLook &sun, const kernel::EntryLook &seen,
                                     std::size_t words, float *count) {
    for (std::size_t k = 0; k < 9; ++k) {
      int sum = 0;
      for (std::size_t w = 0; w < words; ++w)
        sum += joint(sun, seen, k / 3, k % 3, w / lanes, w % lanes);
      count[k] = static_cast<float>(sum);
    }
  }
};

} // namespace umov::backend
