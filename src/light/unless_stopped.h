#pragma once
// What was stopped in the middle has nothing to show.

#include <umov/core/stop.h>

namespace umov {

/// What `make()` returns; nothing (false, no values) for a Failure that it throws once `cancel`,
/// which may be null, became true. Another Failure goes on.
template <class Make>
auto unless_stopped(const std::atomic<bool> *cancel, const Make &make) -> decltype(make()) {
#ifdef __cpp_exceptions
  try {
    return make();
  } catch (const Failure &) {
    if (!is_stopped(cancel))
      throw;
    return {};
  }
#else
  return make();
#endif
}

} // namespace umov
