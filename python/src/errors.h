#pragma once
// Private: errors of the library as exceptions of umov.errors.

#include <nanobind/nanobind.h>
#include <umov/core/result.h>
#include <utility>

namespace umov::python {

namespace nb = nanobind;

/// The value, or the error thrown.
template <class T> T take(Result<T> &&result) {
  if (!result)
    throw Failure(std::move(result).error());
  if constexpr (!std::is_void_v<T>)
    return std::move(*result);
}

/// (code, message, file, line, column), or None.
nb::object tuple_of(const Error *error);

/// Has every Failure raised by umov.errors.raise_for.
void translate_errors();

} // namespace umov::python
