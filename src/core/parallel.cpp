#include <algorithm>
#include <thread>
#include <umov/core/parallel.h>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace umov {

unsigned resolve_threads(unsigned requested) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  return requested == 0 ? cores : std::min(requested, 1024u);
}

void parallel_for(std::size_t count, unsigned threads,
                  const std::function<void(std::size_t)> &body) {
  const unsigned used = resolve_threads(threads);
  if (used == 1 || count < 2) {
    for (std::size_t i = 0; i < count; ++i)
      body(i);
    return;
  }
  // The control lets a user ask for more threads than there are cores (determinism tests do).
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, used);
  tbb::task_arena arena(static_cast<int>(used));
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1), [&](const auto &range) {
      for (std::size_t i = range.begin(); i != range.end(); ++i)
        body(i);
    });
  });
}

} // namespace umov
