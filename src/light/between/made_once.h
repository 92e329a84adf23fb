#pragma once
// Private: what is made when somebody first needs it, unless he is stopped meanwhile.

#include <atomic>
#include <memory>
#include <umov/core/locks.h>
#include <umov/core/stop.h>

namespace umov {

/// Something that is made once. Thread safe; who comes later does not wait for a lock.
template <class T> class MadeOnce {
public:
  /// What `make()`, a unique_ptr, made. Null where `cancel` became true meanwhile: what came of it
  /// is let go, and whoever asks next begins anew.
  template <class Make> const T *get(const std::atomic<bool> *cancel, const Make &make) {
    if (const T *made = made_.load(std::memory_order_acquire))
      return made;
    const WriteLock lock(mutex_);
    if (!kept_) {
      std::unique_ptr<const T> made = make();
      if (is_stopped(cancel))
        return nullptr;
      kept_ = std::move(made);
      made_.store(kept_.get(), std::memory_order_release);
    }
    return kept_.get();
  }

private:
  Mutex mutex_;
  std::unique_ptr<const T> kept_;
  std::atomic<const T *> made_{nullptr}; ///< `kept_`, for who looks without the lock
};

} // namespace umov
