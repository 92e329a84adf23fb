#include "errors.h"

#include <nanobind/stl/string.h>

namespace umov::python {

nb::object tuple_of(const Error *error) {
  if (error == nullptr)
    return nb::none();
  return nb::make_tuple(static_cast<int>(error->code), error->message, error->where.file,
                        error->where.line, error->where.column);
}

void translate_errors() {
  nb::register_exception_translator([](const std::exception_ptr &pointer, void *) {
    try {
      std::rethrow_exception(pointer);
    } catch (const Failure &failure) {
      const nb::object made =
          nb::module_::import_("umov.errors").attr("error_from")(tuple_of(&failure.error()));
      PyErr_SetObject(reinterpret_cast<PyObject *>(Py_TYPE(made.ptr())), made.ptr());
    }
  });
}

} // namespace umov::python
