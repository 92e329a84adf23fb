#pragma once
// Private: what several bindings say of jobs.

#include <umov/core/result.h>

namespace umov::python {

/// The job ended because it was asked to.
template <class T> bool was_interrupted(const Result<T> &result) {
  return !result && result.error().code == ErrorCode::Interrupted;
}

} // namespace umov::python
