#pragma once
// Private: what is made when somebody first needs it, unless he is stopped meanwhile.

#include <atomic>
#include <memory>
#include <umov/core/locks.h>
#include <umov/core/stop.h>

namespace umov {

/// What `make()`, a pointer, made once and put into `kept`. Null where `cancel` became true
/// meanwhile: what came of it is let go, and whoever asks next begins anew.
template <class T, class Make>
const T *made_once(Mutex &mutex, std::unique_ptr<const T> &kept, const std::atomic<bool> *cancel,
                   const Make &make) {
  const WriteLock lock(mutex);
  if (!kept) {
    std::unique_ptr<const T> made = make();
    if (is_stopped(cancel))
      return nullptr;
    kept = std::move(made);
  }
  return kept.get();
}

} // namespace umov
