#include "gil.h"

#include <atomic>
#include <chrono>
#include <pthread.h>
#include <thread>

namespace umov::python {
namespace {

std::atomic<int> away{0}; ///< threads between leaving the GIL and having it back
std::atomic<bool> has_begun_to_end{false};
std::thread::id ender; ///< set before the flag; the thread that goes on

[[nodiscard]] bool must_wait() { return has_begun_to_end && std::this_thread::get_id() != ender; }

[[noreturn]] void wait_for_the_end() {
  --away;
  for (;;)
    std::this_thread::sleep_for(std::chrono::hours(1));
}

void wait_for_others() {
  ender = std::this_thread::get_id();
  has_begun_to_end = true;
  // What a thread that never ends holds is no leak.
  if (nanobind::cast<int>(nanobind::module_::import_("threading").attr("active_count")()) > 1)
    nanobind::set_leak_warnings(false);
  PyThreadState *state = PyEval_SaveThread();
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  while (away > 0 && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  PyEval_RestoreThread(state);
}

} // namespace

bool is_ending() { return has_begun_to_end; }

WithoutGil::WithoutGil() {
  ++away;
  leave();
}
WithoutGil::~WithoutGil() {
  take();
  --away;
}

void WithoutGil::leave() { state_ = PyEval_SaveThread(); }
void WithoutGil::take() {
  if (must_wait())
    wait_for_the_end();
  PyEval_RestoreThread(state_);
}

void watch_the_end() {
  // A forked child has one thread, whatever its parent's did.
  pthread_atfork(nullptr, nullptr, [] { away = 0; });
  nanobind::module_::import_("atexit").attr("register")(nanobind::cpp_function(wait_for_others));
}

} // namespace umov::python
