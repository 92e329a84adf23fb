#pragma once
// Memory for tables that are read at random: with pages of 4 KB most reads would first have to find
// their page.

#include <cstddef>
#include <cstdlib>
#include <new>
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace umov {

/// Allocates in whole huge pages and asks the system to use them; without such a system, aligned
/// memory like any other.
template <class T> struct HugePageAllocator {
  using value_type = T;
  HugePageAllocator() = default;
  template <class U> HugePageAllocator(const HugePageAllocator<U> &) {}

  T *allocate(std::size_t count) {
    constexpr std::size_t page = std::size_t{2} << 20;
    const std::size_t bytes = count * sizeof(T);
    const std::size_t align = bytes >= page ? page : 64;
    void *p = std::aligned_alloc(align, (bytes + align - 1) / align * align);
    if (p == nullptr) {
#ifdef __cpp_exceptions
      throw std::bad_alloc();
#else
      std::abort();
#endif
    }
#if defined(__linux__)
    if (bytes >= page)
      madvise(p, (bytes + align - 1) / align * align, MADV_HUGEPAGE); // a wish: may be refused
#endif
    return static_cast<T *>(p);
  }
  void deallocate(T *p, std::size_t) { std::free(p); }
  template <class U> bool operator==(const HugePageAllocator<U> &) const { return true; }
};

} // namespace umov
