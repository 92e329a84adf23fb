#pragma once
// Private: a job on a thread of its own, while the caller's thread looks after Python.

#include "gil.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <optional>
#include <string>
#include <thread>
#include <umov/core/diagnostics.h>
#include <umov/jobs/monitor.h>
#include <utility>

namespace umov::python {

namespace nb = nanobind;

/// What a job tells, kept until the thread that called from Python comes round to hand it on: no
/// thread of the job ever waits for Python, and a callback runs where it was given.
class Attention {
public:
  /// `watch`: an object with progress(what, done, total), remark(text) and warn(text), or None.
  explicit Attention(nb::handle watch) : watch_(nb::borrow(watch)) {}
  Attention(const Attention &) = delete;
  Attention &operator=(const Attention &) = delete;

  /// For the job.
  [[nodiscard]] jobs::Monitor monitor();
  Diagnostics diagnostics;

  /// Hands on what has come, and asks whether Python wants to stop. With the GIL; never throws: the
  /// first exception is kept and the job is told to stop.
  void look();
  /// Tells the job to stop, without a word to Python.
  void stop() { cancel_ = true; }
  /// The job is done. From any thread.
  void finish();
  /// True once the job is done; waits for that as long as a look may wait, a twentieth of a second.
  bool wait();
  /// Gives the warnings to Python and throws what a callback threw. Ctrl-C is thrown unless the job
  /// `was_stopped` by it, which the caller then tells with what is done.
  void settle(bool was_stopped);

private:
  struct Step {
    std::string what;
    std::size_t done = 0, total = 0;
  };
  void hand_on();

  nb::object watch_;
  std::atomic<bool> cancel_{false};
  std::mutex lock_;
  std::condition_variable changed_;
  bool is_done_ = false;
  std::optional<Step> step_;
  std::deque<std::string> remarks_;
  std::exception_ptr problem_;
  bool is_interrupt_ = false; ///< problem_ is KeyboardInterrupt
};

/// Runs `job(monitor, diagnostics)` so and returns what it returned. Call `settle` afterwards.
template <class Job> auto attend(Attention &attention, Job job) {
  using Out = decltype(job(std::declval<const jobs::Monitor &>(), attention.diagnostics));
  const jobs::Monitor monitor = attention.monitor();
  std::optional<Out> out;
  std::exception_ptr failure;
  {
    WithoutGil gil;
    const auto work = [&] {
      try {
        out.emplace(job(monitor, attention.diagnostics));
      } catch (...) {
        failure = std::current_exception();
      }
      attention.finish();
    };
    std::thread worker(work);
    while (!attention.wait()) {
      if (is_ending()) {
        attention.stop();
        continue;
      }
      gil.take();
      attention.look();
      gil.leave();
    }
    worker.join();
  }
  attention.look();
  if (failure)
    std::rethrow_exception(failure);
  return std::move(*out);
}

/// Runs `body(i)` for i from 0 to `count`, a single one where it is and more so that Ctrl-C ends
/// them, which is then thrown.
template <class Body> void in_parts(std::size_t count, const Body &body) {
  if (count < 2) {
    for (std::size_t i = 0; i < count; ++i)
      body(i);
    return;
  }
  Attention attention{nb::none()};
  attend(attention, [&](const jobs::Monitor &monitor, Diagnostics &) {
    for (std::size_t i = 0; i < count && !monitor.is_cancelled(); ++i)
      body(i);
    return true;
  });
  attention.settle(false);
}

/// Why a job of `count` poses ended after `done` of them.
Error stopped_after(std::size_t done, std::size_t count);

} // namespace umov::python
