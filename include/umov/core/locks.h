#pragma once
// Locks by two names, for machines without threads too: the C++ library of WebAssembly has none.

#ifdef __wasi__

namespace umov {

/// Nobody else runs: there is nothing to keep out.
struct Mutex {};
/// Held by one who looks, with others who look.
struct [[nodiscard]] ReadLock {
  ReadLock() = default;
  explicit ReadLock(Mutex &) {}
};
/// Held by one who changes, alone.
struct [[nodiscard]] WriteLock {
  explicit WriteLock(Mutex &) {}
};

} // namespace umov

#else

#include <mutex>
#include <shared_mutex>

namespace umov {

/// What is shared and changes.
using Mutex = std::shared_mutex;
/// Held by one who looks, with others who look.
using ReadLock = std::shared_lock<Mutex>;
/// Held by one who changes, alone.
using WriteLock = std::unique_lock<Mutex>;

} // namespace umov

#endif
