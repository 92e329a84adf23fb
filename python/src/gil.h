#pragma once
// Private: the interpreter's lock is given away while C++ works, and asked for with care.

#include <nanobind/nanobind.h>

namespace umov::python {

/// The GIL is free while one of these lives, for whoever held it. Python before 3.14 ends a thread
/// that asks for it once the interpreter has begun to end, by unwinding its frames: those of C++ do
/// not bear that, and the process would abort at the end of a script that did all it should. Such a
/// thread (a daemon of the user's) waits here instead until the process is gone, as it does in
/// Python 3.14.
class WithoutGil {
public:
  WithoutGil();
  ~WithoutGil();
  WithoutGil(const WithoutGil &) = delete;
  WithoutGil &operator=(const WithoutGil &) = delete;

  /// For a callback in between.
  void take();
  void leave();

private:
  PyThreadState *state_;
};

/// The interpreter has begun to end: who works should stop.
bool is_ending();

/// Makes the end of the interpreter wait, two seconds at most, until the threads that work here
/// have stopped.
void watch_the_end();

} // namespace umov::python
