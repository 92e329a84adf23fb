#include <umov/scale/shard_work.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <unistd.h>
#include <utility>

namespace umov::scale {
namespace {

/// What the parent asks for. When it ends without a word (or on purpose), so does the work.
class Asked {
public:
  Asked() : reader_([this] { read(); }) { reader_.detach(); }

  /// Waits for the next index; empty at the end.
  std::optional<std::size_t> next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_over_ || !indices_.empty(); });
    if (is_over_ || indices_.empty())
      return std::nullopt;
    const std::size_t out = indices_.front();
    indices_.pop_front();
    return out;
  }
  const std::atomic<bool> &is_over() const { return is_over_; }

private:
  void take(const std::string &line) {
    std::size_t index = 0;
    if (std::from_chars(line.data(), line.data() + line.size(), index).ec != std::errc())
      return;
    const std::scoped_lock lock(mutex_);
    indices_.push_back(index);
    changed_.notify_all();
  }
  void read() {
    std::string line;
    char c = 0;
    while (::read(STDIN_FILENO, &c, 1) == 1)
      if (c == '\n')
        take(std::exchange(line, {}));
      else
        line += c;
    is_over_ = true;
    changed_.notify_all();
    // The shard in hand ends within a block of rows and removes its file; what hangs ends here.
    std::this_thread::sleep_for(std::chrono::seconds(5));
    ::_exit(EXIT_FAILURE);
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::size_t> indices_;
  std::atomic<bool> is_over_ = false;
  std::thread reader_;
};

Asked &asked() {
  static Asked out; // outlives the thread that reads
  return out;
}

Result<void> say(const std::string &line) {
  const std::string all = line + "\n";
  std::size_t at = 0;
  while (at < all.size()) {
    const ssize_t written = ::write(STDOUT_FILENO, all.data() + at, all.size() - at);
    if (written <= 0)
      return fail(ErrorCode::Device, "nobody listens to the records");
    at += static_cast<std::size_t>(written);
  }
  return {};
}

} // namespace

void refuse_shards(const Error &why) {
  ShardRecord out;
  out.status = ShardRecord::Status::Refused;
  out.code = static_cast<int>(why.code);
  out.message = why.text();
  (void)say(to_json(out));
}

const std::atomic<bool> &parent_has_left() { return asked().is_over(); }

Result<void> serve_shards(const JobFolder &folder, jobs::RangedJob &job) {
  jobs::Monitor monitor;
  monitor.cancel = &parent_has_left();
  bool has_kept = false;
  UMOV_TRY(job.keep()); // from here on, of each object that a shard is done with
  while (const auto index = asked().next()) {
    const ShardRecord record = do_shard(folder, job, *index, monitor);
    UMOV_TRY(say(to_json(record)));
    if (record.status == ShardRecord::Status::Exhausted)
      return {}; // what took the memory may hold it still
    if (!std::exchange(has_kept, true))
      UMOV_TRY(job.keep()); // for the processes that start after this one
  }
  return parent_has_left() ? job.keep() : Result<void>();
}

} // namespace umov::scale
