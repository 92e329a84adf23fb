#include <umov/scale/run_job.h>

#include "scale/this_process.h"
#include "scale/time_left.h"
#include "scale/worker_process.h"

#include <algorithm>
#include <cstring>
#include <deque>
#include <fmt/format.h>
#include <map>
#include <poll.h>
#include <random>
#include <umov/core/parallel.h>
#include <umov/scale/lease.h>

namespace umov::scale {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t attempts_max = 3;
/// Of what hangs: each costs ten times what the shard should have taken.
constexpr std::size_t attempts_at_hangs_max = 2;
/// Of what has no memory, one after the other: where nothing was done no other shard will be.
constexpr std::size_t exhausted_max = 10;
constexpr double patience_after_stop_s = 30;

/// The loop over workers.
class Pool {
public:
  Pool(const JobFolder &folder, const RunSettings &settings, const jobs::Monitor &monitor)
      : folder_(folder), settings_(settings), monitor_(monitor),
        clock_(clock_of(folder.lock(), threads_of_worker())) {}

  Result<RunTally> run() {
    UMOV_TRY(find_missing());
    const std::size_t there = tally_.there_before;
    while (!workers_.empty() || may_start()) {
      if (!stopped_ && monitor_.is_cancelled())
        stop({ErrorCode::Interrupted, "", {}});
      UMOV_TRY(start_workers());
      if (workers_.empty())
        break;
      wait();
      end_what_hangs();
      monitor_.advance("shards", there + tally_.done + tally_.failed, tally_.wanted);
      tell_what_is_left();
    }
    if (!stopped_)
      return tally_;
    if (stopped_->code == ErrorCode::Interrupted)
      stopped_->message =
          fmt::format("stopped by the user after {} of {} shards. umov scale run {} goes on.",
                      there + tally_.done, tally_.wanted, folder_.path().string());
    return tl::unexpected(*stopped_);
  }

private:
  Result<void> find_missing() {
    const JobLock &lock = folder_.lock();
    UMOV_ASSIGN(part, settings_.part.of(lock.shards(), "shards"));
    UMOV_ASSIGN(there, folder_.shards());
    tally_.wanted = part.count;
    for (std::size_t k = part.first; k < part.end(); ++k)
      if (!there.contains(k))
        missing_.push_back(k);
    tally_.there_before = part.count - missing_.size();
    if (settings_.joins)
      go_elsewhere();
    return {};
  }
  /// Far from where the others are. Who only followed them would catch up and do, from there on,
  /// each shard at the same time as they.
  void go_elsewhere() {
    if (missing_.empty())
      return;
    const auto at = static_cast<std::ptrdiff_t>(somewhere_() % missing_.size());
    std::rotate(missing_.begin(), missing_.begin() + at, missing_.end());
  }
  /// In the clock of the workers: each has its share of the predicted CPU time of a shard.
  void tell_what_is_left() const {
    const JobLock &lock = folder_.lock();
    std::size_t units = missing_.size() * lock.per_shard;
    if (!missing_.empty() && missing_.back() + 1 == lock.shards()) // which may be shorter
      units -= lock.per_shard - lock.range(missing_.back()).count;
    std::vector<std::size_t> in_hand;
    std::vector<double> busy;
    for (const WorkerProcess &worker : workers_)
      if (const auto index = worker.index()) {
        in_hand.push_back(lock.range(*index).count);
        busy.push_back(worker.busy_s());
        units += in_hand.back();
      }
    monitor_.tell_left(clock_.left_s(units, in_hand, busy));
  }
  [[nodiscard]] std::size_t threads_of_worker() const {
    return settings_.threads > 0 ? settings_.threads
                                 : std::max<std::size_t>(1, resolve_threads(0) / settings_.workers);
  }
  [[nodiscard]] static TimeLeft clock_of(const JobLock &lock, std::size_t threads) {
    const auto at_once = static_cast<double>(threads);
    return {lock.rate.cpu_s / at_once, lock.rate.setup_cpu_s + lock.rate.once_cpu_s / at_once};
  }
  [[nodiscard]] bool may_start() const { return !stopped_ && !missing_.empty(); }
  void stop(Error why) {
    if (!stopped_)
      stopped_since_ = WorkerProcess::Clock::now();
    stopped_ = std::move(why);
  }
  Result<void> start_workers() {
    while (may_start() && workers_.size() < settings_.workers) {
      const std::size_t memory_mb =
          settings_.memory_mb > 0 ? settings_.memory_mb
                                  : std::max<std::size_t>(64, memory_here_mb() / settings_.workers);
      UMOV_ASSIGN(worker, WorkerProcess::start({settings_.program, "scale", "worker",
                                                folder_.path().string(), "--threads",
                                                std::to_string(threads_of_worker()), "--memory-mb",
                                                std::to_string(memory_mb), "-q"}));
      workers_.push_back(std::move(worker));
      give(workers_.back());
    }
    return {};
  }
  /// The next shard that nobody has done meanwhile. False: there is none, and it may go.
  bool give(WorkerProcess &worker) {
    if (!may_start())
      return false;
    worker.ask(missing_.front());
    missing_.pop_front();
    return true;
  }
  void wait() {
    std::vector<pollfd> ends;
    for (const WorkerProcess &worker : workers_)
      ends.push_back({worker.output(), POLLIN, 0});
    ::poll(ends.data(), ends.size(), 200);
    for (std::size_t k = workers_.size(); k-- > 0;)
      if ((ends[k].revents & (POLLIN | POLLHUP)) != 0)
        hear(k);
  }
  void hear(std::size_t k) {
    WorkerProcess &worker = workers_[k];
    const bool lives = worker.read();
    while (const auto line = worker.line()) {
      if (!take(*line) || !give(worker)) {
        worker.leave(milliseconds(10'000)); // it keeps its masks
        return let_go(k);
      }
    }
    if (!lives)
      lose(k, "");
  }
  void let_go(std::size_t k) { workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(k)); }
  /// False: its process ends.
  bool take(const std::string &line) {
    const auto record = record_from_json(line);
    if (!record) {
      stop(record.error());
      return false;
    }
    note(*record);
    return record->status != ShardRecord::Status::Exhausted;
  }
  void note(const ShardRecord &record) {
    tally_.cpu_s += record.cpu_s;
    const auto code = static_cast<ErrorCode>(record.code);
    if (record.status == ShardRecord::Status::Refused)
      return stop({code, record.message, {}});
    if (record.status == ShardRecord::Status::Exhausted)
      return exhaust(record);
    exhausted_ = 0;
    if (record.status != ShardRecord::Status::Failed) {
      ++tally_.done;
      if (record.status == ShardRecord::Status::Done)
        clock_.took(folder_.lock().range(record.index).count, record.seconds,
                    tally_.done <= settings_.workers);
      if (record.status == ShardRecord::Status::There) {
        ++tally_.by_others;
        go_elsewhere();
      }
      return folder_.forget_failed(record.index);
    }
    if (code == ErrorCode::Device || code == ErrorCode::Interrupted)
      return stop({code,
                   fmt::format("{} umov scale run {} goes on when that is mended.", record.message,
                               folder_.path().string()),
                   {}});
    give_up(record.index, record.code, attempts_[record.index] + 1, record.message);
  }
  void exhaust(const ShardRecord &record) {
    if (++exhausted_ >= exhausted_max && tally_.done == 0)
      return stop(
          {ErrorCode::Device,
           fmt::format("{} attempts ran out of memory one after the other, and no shard was "
                       "done: {} umov scale run {} goes on.",
                       exhausted_, record.message, folder_.path().string()),
           {}});
    again_or_never(record.index, record.code, attempts_max, record.message);
  }
  void give_up(std::size_t index, int code, std::size_t attempts, const std::string &message) {
    ++tally_.failed;
    tally_.failures.push_back({index, code, attempts, message, this_host()});
    folder_.tell_failed(tally_.failures.back());
  }
  /// A worker that is no more, or shall not be (`why`: it hangs): its shard is tried again, but not
  /// for ever.
  void lose(std::size_t k, const std::string &why) {
    const auto index = workers_[k].index();
    const int code = workers_[k].end();
    let_go(k);
    if (!index || stopped_)
      return;
    const std::string what = !why.empty() ? why
                             : code > 128 ? fmt::format("its process was ended by signal {} ({})",
                                                        code - 128, ::strsignal(code - 128))
                                          : fmt::format("its process ended with {}", code);
    again_or_never(*index, code, why.empty() ? attempts_max : attempts_at_hangs_max, what);
  }
  void again_or_never(std::size_t index, int code, std::size_t most, const std::string &what) {
    if (const std::size_t attempts = ++attempts_[index]; attempts >= most)
      give_up(index, code, attempts, what);
    else
      missing_.push_back(index); // behind the others, which it shall not hold up
  }
  void end_what_hangs() {
    const JobLock &lock = folder_.lock();
    const double timeout = settings_.timeout_s > 0
                               ? settings_.timeout_s
                               : std::max(60.0, 10 * lock.rate.at_most_s(lock.per_shard));
    const double since_stop =
        stopped_
            ? std::chrono::duration<double>(WorkerProcess::Clock::now() - stopped_since_).count()
            : 0;
    for (std::size_t k = workers_.size(); k-- > 0;)
      if (since_stop > patience_after_stop_s) {
        workers_[k].leave(milliseconds(6000));
        let_go(k);
      } else if (workers_[k].busy_s() > timeout) {
        lose(k, fmt::format("it was not done after {:.0f} s", timeout));
      }
  }

  const JobFolder &folder_;
  const RunSettings &settings_;
  const jobs::Monitor &monitor_;
  TimeLeft clock_;
  std::size_t exhausted_ = 0; ///< attempts since the last that was not
  RunTally tally_;
  std::deque<std::size_t> missing_;
  std::random_device somewhere_;
  std::map<std::size_t, std::size_t> attempts_;
  std::vector<WorkerProcess> workers_;
  std::optional<Error> stopped_;
  WorkerProcess::Clock::time_point stopped_since_{};
};

} // namespace

Result<RunTally> run_job(const JobFolder &folder, const RunSettings &settings,
                         const jobs::Monitor &monitor) {
  std::string part = settings.part.text();
  for (const char sign : {'/', ':'})
    if (const std::size_t at = part.find(sign); at != std::string::npos)
      part.replace(at, 1, sign == '/' ? "-of-" : "-and-");
  UMOV_ASSIGN(lease,
              settings.joins ? Lease::join(folder.path()) : Lease::take(folder.path(), part));
  if (lease.is_alone()) // what grows beside us is somebody's
    folder.sweep();
  auto out = Pool(folder, settings, monitor).run();
  if (lease.is_alone())
    folder.sweep();
  return out;
}

} // namespace umov::scale
