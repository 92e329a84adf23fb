#pragma once
// Who watches a job: a terminal, a notebook, a service, or nobody.

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>

namespace umov::jobs {

/// All may be empty. What is called is called from any thread of the job, one call at a time.
struct Monitor {
  /// What is being done, and how much of it: "poses", 1024, 5000.
  std::function<void(const std::string &what, std::size_t done, std::size_t total)> progress;
  /// How many seconds are left, from a job that knows better than the rate of `progress`.
  std::function<void(double seconds)> left;
  /// A line of the log.
  std::function<void(const std::string &text)> remark;
  /// Set to true from any thread to have the job stop soon, with what is complete kept.
  const std::atomic<bool> *cancel = nullptr;

  /// What `cancel` is, or what is never true.
  [[nodiscard]] const std::atomic<bool> &cancel_flag() const {
    static const std::atomic<bool> never{false};
    return cancel != nullptr ? *cancel : never;
  }
  /// A line of the log, if anybody listens.
  void tell(const std::string &text) const {
    if (remark)
      remark(text);
  }
  /// Progress, if anybody listens.
  void advance(const std::string &what, std::size_t done, std::size_t total) const {
    if (progress)
      progress(what, done, total);
  }
  /// What is left, if anybody listens.
  void tell_left(double seconds) const {
    if (left)
      left(seconds);
  }
  /// The job is to stop soon.
  [[nodiscard]] bool is_cancelled() const { return cancel != nullptr && *cancel; }
};

} // namespace umov::jobs
