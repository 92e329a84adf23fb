#pragma once
// One moving line on a terminal; nothing anywhere else.

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace umov::cli {

/// Draws itself four times a second, also while nothing is reported: a job that is still making
/// masks, or searching, is seen to live. Gone when all is done.
class ProgressBar {
public:
  /// `wait`: what takes the time before the first piece is done; "": nobody can say.
  ProgressBar(std::string what, std::string wait, bool is_quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar &) = delete;
  ProgressBar &operator=(const ProgressBar &) = delete;
  /// From any thread.
  void update(std::size_t done, std::size_t total);
  /// So many seconds are left, as the job itself knows.
  void expect(double seconds);

private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] std::string line() const;
  [[nodiscard]] std::string left() const;
  void keep_drawing(const std::stop_token &stop);

  const std::string what_, wait_;
  const Clock::time_point begin_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable_any stopped_;
  std::size_t done_ = 0, total_ = 0;
  bool has_drawn_ = false;
  std::optional<std::pair<Clock::time_point, double>> expected_; ///< what was left when
  /// What was done when, lately: the rate of now, not that of a slow beginning.
  std::deque<std::pair<Clock::time_point, std::size_t>> lately_;
  std::jthread drawer_; ///< last: it reads all of the above
};

} // namespace umov::cli
