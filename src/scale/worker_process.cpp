#include "scale/worker_process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>

extern char **environ; // NOLINT(readability-redundant-declaration): POSIX has it in no header

namespace umov::scale {
namespace {

/// Neither end stays open in other children: a worker must see the end of its own parent.
bool make_pipe(std::array<int, 2> &ends) {
  if (::pipe(ends.data()) != 0)
    return false;
  for (const int end : ends)
    ::fcntl(end, F_SETFD, FD_CLOEXEC);
  return true;
}

} // namespace

Result<WorkerProcess> WorkerProcess::start(const std::vector<std::string> &command) {
  std::array<int, 2> in{}, out{};
  WorkerProcess worker;
  if (!make_pipe(in) || !make_pipe(out))
    return fail(ErrorCode::Device, std::string("no pipe to a worker: ") + std::strerror(errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  std::vector<char *> arguments;
  for (const std::string &word : command)
    arguments.push_back(const_cast<char *>(word.c_str()));
  arguments.push_back(nullptr);
  const int cause =
      ::posix_spawn(&worker.pid_, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(in[0]);
  ::close(out[1]);
  worker.input_ = in[1];
  worker.output_ = out[0];
  if (cause == 0)
    return worker;
  worker.pid_ = -1;
  return fail(ErrorCode::Device, std::string("a worker cannot be started: ") + std::strerror(cause),
              {command.front()});
}

WorkerProcess::WorkerProcess(WorkerProcess &&other) noexcept { *this = std::move(other); }
WorkerProcess &WorkerProcess::operator=(WorkerProcess &&other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(input_, other.input_);
  std::swap(output_, other.output_);
  std::swap(read_, other.read_);
  std::swap(index_, other.index_);
  std::swap(since_, other.since_);
  return *this;
}
WorkerProcess::~WorkerProcess() { end(); }

void WorkerProcess::ask(std::size_t index) {
  index_ = index;
  since_ = Clock::now();
  const std::string line = std::to_string(index) + "\n";
  // One that died meanwhile is found by its end: its pipe shall not end this process.
  sigset_t pipe, before;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe, &before);
  if (::write(input_, line.data(), line.size()) < 0 && errno == EPIPE) {
    const timespec now{};
    sigtimedwait(&pipe, nullptr, &now); // takes what is pending
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

double WorkerProcess::busy_s() const {
  return index_ ? std::chrono::duration<double>(Clock::now() - since_).count() : 0;
}

bool WorkerProcess::read() {
  std::array<char, 4096> block{};
  const ssize_t count = ::read(output_, block.data(), block.size());
  if (count > 0)
    read_.append(block.data(), static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && errno == EINTR);
}

std::optional<std::string> WorkerProcess::line() {
  const std::size_t end = read_.find('\n');
  if (end == std::string::npos)
    return std::nullopt;
  std::string out = read_.substr(0, end);
  read_.erase(0, end + 1);
  index_.reset();
  return out;
}

void WorkerProcess::close_pipes() {
  for (int *end : {&input_, &output_})
    if (const int open = std::exchange(*end, -1); open >= 0)
      ::close(open);
}

void WorkerProcess::leave(std::chrono::milliseconds patience) {
  if (const int open = std::exchange(input_, -1); open >= 0)
    ::close(open);
  const auto until = Clock::now() + patience;
  int status = 0;
  while (pid_ > 0 && Clock::now() < until) {
    if (::waitpid(pid_, &status, WNOHANG) == pid_)
      pid_ = -1;
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

int WorkerProcess::end() {
  close_pipes();
  if (pid_ <= 0)
    return 0;
  int status = 0;
  // One that ended by itself is not yet waited for: its own status is what is got.
  ::kill(pid_, SIGKILL);
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

} // namespace umov::scale
