#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <umov/core/parallel.h>
#include <vector>

namespace umov {

unsigned resolve_threads(unsigned requested) {
  if (requested != 0)
    return std::min(requested, 1024u);
  // Asked once: the library opens files for it, which costs more than a pose.
  static const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  return cores;
}

void parallel_for(std::size_t count, unsigned threads,
                  const std::function<void(std::size_t)> &body) {
  const auto used = static_cast<unsigned>(std::min<std::size_t>(resolve_threads(threads), count));
  if (used < 2) {
    for (std::size_t i = 0; i < count; ++i)
      body(i);
    return;
  }
  // Plain threads that fetch the next index: the units are large (milliseconds), starting a thread
  // costs microseconds, and a user may ask for more threads than there are cores.
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_lock;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++)
        body(i);
    } catch (...) {
      const std::lock_guard lock(failure_lock);
      failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> helpers;
  // A container or the user may allow fewer threads (ulimit -u) or less memory for their stacks:
  // those there are do all of the work. Leaving with joinable threads would end the program.
  try {
    helpers.reserve(used - 1);
    for (unsigned t = 1; t < used; ++t)
      helpers.emplace_back(work);
  } catch (const std::system_error &) {
  } catch (const std::bad_alloc &) {
  }
  work();
  for (std::thread &helper : helpers)
    helper.join();
  if (failure)
    std::rethrow_exception(failure);
}

} // namespace umov
