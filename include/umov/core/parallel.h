#pragma once
#include <cstddef>
#include <functional>

namespace umov {

/// Number of threads to use when the user asks for `requested` (0: all cores; at most 1024).
unsigned resolve_threads(unsigned requested);

/// Runs `body(i)` for i in [0, count) on up to `threads` threads, fewer where the system gives no
/// more. An exception of a body is thrown again here when all threads have ended. Every parallel
/// loop of the project goes through here. `body` must write only to slots of its own index, so that
/// results do not depend on the number of threads; partial sums are folded by the caller in index
/// order.
void parallel_for(std::size_t count, unsigned threads,
                  const std::function<void(std::size_t)> &body);

} // namespace umov
