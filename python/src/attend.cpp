#include "attend.h"

#include <chrono>
#include <fmt/format.h>

namespace umov::python {

jobs::Monitor Attention::monitor() {
  jobs::Monitor out;
  out.cancel = &cancel_;
  if (watch_.is_none())
    return out;
  out.progress = [this](const std::string &what, std::size_t done, std::size_t total) {
    const std::lock_guard guard(lock_);
    step_ = Step{what, done, total};
  };
  out.remark = [this](const std::string &text) {
    const std::lock_guard guard(lock_);
    remarks_.push_back(text);
  };
  return out;
}

void Attention::hand_on() {
  std::optional<Step> step;
  std::deque<std::string> remarks;
  {
    const std::lock_guard guard(lock_);
    step.swap(step_);
    remarks.swap(remarks_);
  }
  for (const std::string &text : remarks)
    watch_.attr("remark")(text);
  if (step)
    watch_.attr("progress")(step->what, step->done, step->total);
}

void Attention::look() {
  if (problem_)
    return;
  try {
    if (PyErr_CheckSignals() != 0)
      throw nb::python_error();
    hand_on();
  } catch (const nb::python_error &error) {
    is_interrupt_ = error.matches(PyExc_KeyboardInterrupt);
    problem_ = std::current_exception();
    cancel_ = true;
  } catch (...) {
    problem_ = std::current_exception();
    cancel_ = true;
  }
}

void Attention::finish() {
  const std::lock_guard guard(lock_);
  is_done_ = true;
  changed_.notify_one();
}

bool Attention::wait() {
  std::unique_lock guard(lock_);
  return changed_.wait_for(guard, std::chrono::milliseconds(50), [this] { return is_done_; });
}

void Attention::settle(bool was_stopped) {
  if (problem_ && !(was_stopped && is_interrupt_))
    std::rethrow_exception(problem_);
  if (!watch_.is_none())
    for (const Warning &warning : diagnostics.warnings())
      watch_.attr("warn")(warning.text());
}

Error stopped_after(std::size_t done, std::size_t count) {
  return {ErrorCode::Interrupted,
          fmt::format("stopped by the user after {} of {} poses", done, count),
          {}};
}

} // namespace umov::python
