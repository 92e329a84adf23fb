#pragma once
// Work that somebody may end: Ctrl-C, a notebook, a service.

#include <atomic>
#include <umov/core/result.h>

namespace umov {

/// Somebody wants the work to end. nullptr: nobody can.
inline bool is_stopped(const std::atomic<bool> *cancel) { return cancel != nullptr && *cancel; }

/// Throws Failure (Interrupted). Where there are no exceptions, as on a page, whose worker is ended
/// instead, it ends the program.
[[noreturn]] void leave_stopped();

/// For what makes something ready and has no other way out, constructors and the loops they call:
/// throws Failure (Interrupted) once `cancel`, which may be null, became true.
inline void leave_if_stopped(const std::atomic<bool> *cancel) {
  if (is_stopped(cancel))
    leave_stopped();
}

/// The same in a loop of short rounds: asked every thousandth of them.
inline void leave_if_stopped(const std::atomic<bool> *cancel, std::size_t round) {
  if (round % 1024 == 0)
    leave_if_stopped(cancel);
}

/// What `make()` returns, a Result; the error of a Failure that it throws.
template <class Make> auto without_failures(const Make &make) -> decltype(make()) {
#ifdef __cpp_exceptions
  try {
    return make();
  } catch (const Failure &failure) {
    return tl::unexpected(failure.error());
  }
#else
  return make();
#endif
}

} // namespace umov
