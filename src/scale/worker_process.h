#pragma once
// Private: a process that does shards, at the other end of two pipes.

#include <chrono>
#include <optional>
#include <string>
#include <sys/types.h>
#include <umov/core/result.h>
#include <vector>

namespace umov::scale {

/// Ends with its parent: its standard input does.
class WorkerProcess {
public:
  using Clock = std::chrono::steady_clock;
  /// Device if it cannot be started.
  static Result<WorkerProcess> start(const std::vector<std::string> &command);
  WorkerProcess(WorkerProcess &&other) noexcept;
  WorkerProcess &operator=(WorkerProcess &&other) noexcept;
  WorkerProcess(const WorkerProcess &) = delete;
  WorkerProcess &operator=(const WorkerProcess &) = delete;
  ~WorkerProcess(); ///< kills it if it lives

  /// Gives it a shard.
  void ask(std::size_t index);
  [[nodiscard]] std::optional<std::size_t> index() const { return index_; }
  [[nodiscard]] double busy_s() const;
  [[nodiscard]] int output() const { return output_; }
  /// Reads what is there; false at the end of the process.
  [[nodiscard]] bool read();
  /// The next whole line of what was read; the shard in hand is then done.
  std::optional<std::string> line();
  /// Lets it end by itself, for so long.
  void leave(std::chrono::milliseconds patience);
  /// Kills it; how it ended: its exit code, or 128 and the signal.
  int end();

private:
  WorkerProcess() = default;
  void close_pipes();
  pid_t pid_ = -1;
  int input_ = -1, output_ = -1;
  std::string read_;
  std::optional<std::size_t> index_;
  Clock::time_point since_{};
};

} // namespace umov::scale
