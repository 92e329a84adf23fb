#pragma once
// Private: what several bindings say of jobs.

#include <string>
#include <umov/core/result.h>
#include <umov/light/light_model.h>

namespace umov::python {

/// The job ended because it was asked to.
template <class T> bool was_interrupted(const Result<T> &result) {
  return !result && result.error().code == ErrorCode::Interrupted;
}

/// Of a word that Python has looked at.
inline LightMethod method_from(const std::string &word) {
  return word == "rays"    ? LightMethod::Rays
         : word == "masks" ? LightMethod::Masks
                           : LightMethod::Auto;
}

} // namespace umov::python
