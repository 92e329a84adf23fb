#pragma once
// Numbers that stand elsewhere, as a pointer and a count: what the loops take on every machine.

#include "kernel/qualifier.h"

#include <cstddef>
#include <type_traits>

namespace umov::backend {

/// The owner outlives it. std::span's functions are none of a graphics processor's.
template <class T> class View {
public:
  View() = default;
  UMOV_KERNEL View(T *data, std::size_t size) : data_(data), size_(size) {}
  /// Of a list that knows its data and size.
  template <class List>
  requires(!std::is_same_v<std::remove_cvref_t<List>, View> &&
           requires(List & list) { static_cast<T *>(list.data()); }) View(List &list)
      : data_(list.data()), size_(list.size()) {}

  UMOV_KERNEL T &operator[](std::size_t i) const { return data_[i]; }
  [[nodiscard]] UMOV_KERNEL T *data() const { return data_; }
  [[nodiscard]] UMOV_KERNEL std::size_t size() const { return size_; }
  [[nodiscard]] UMOV_KERNEL bool empty() const { return size_ == 0; }
  [[nodiscard]] UMOV_KERNEL T *begin() const { return data_; }
  [[nodiscard]] UMOV_KERNEL T *end() const { return data_ + size_; }

private:
  T *data_ = nullptr;
  std::size_t size_ = 0;
};

} // namespace umov::backend
