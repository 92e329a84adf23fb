#pragma once
// Private: numpy arrays over memory of the library, with an owner and without copies.

#include <memory>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <utility>
#include <vector>

namespace umov::python {

namespace nb = nanobind;

/// A read-only column: its memory belongs to `owner`.
template <class T> using View = nb::ndarray<nb::numpy, const T, nb::c_contig>;
/// A site as Python has it: name, latitude, longitude [deg], altitude [m].
using SiteTuple = nb::typed<nb::tuple, nb::str, nb::float_, nb::float_, nb::float_>;
/// Input of floats in C order.
using Vectors = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Numbers = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// Keeps `value` on the heap until the last array over it is gone.
template <class T> nb::capsule keep(std::unique_ptr<T> value) {
  return nb::capsule(value.release(), [](void *p) noexcept { delete static_cast<T *>(p); });
}

/// An array that has taken over a vector.
template <class T>
nb::ndarray<nb::numpy, T, nb::c_contig> array_from(std::vector<T> &&values,
                                                   std::initializer_list<std::size_t> shape) {
  auto held = std::make_unique<std::vector<T>>(std::move(values));
  T *const data = held->data();
  return {data, shape, keep(std::move(held))};
}

/// A new array whose values are still to be written.
template <class T> struct NewArray {
  explicit NewArray(std::size_t count)
      : data(new T[count]), owner(data, [](void *p) noexcept { delete[] static_cast<T *>(p); }) {}
  T *data;
  nb::capsule owner;
  [[nodiscard]] nb::ndarray<nb::numpy, T, nb::c_contig>
  shaped(std::initializer_list<std::size_t> shape) const {
    return {data, shape, owner};
  }
};

} // namespace umov::python
