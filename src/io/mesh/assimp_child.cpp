#include "io/mesh/assimp_child.h"

#include "io/mesh/assimp_scene.h"
#include "io/mesh/mesh_parts.h"

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <umov/core/stop.h>
#include <unistd.h>

namespace umov::mesh_io {
namespace {

constexpr char is_scene = 'S', is_refusal = 'R';

void limit(decltype(RLIMIT_CPU) what, std::size_t value) {
  const struct rlimit both { value, value };
  setrlimit(what, &both);
}

/// Bytes that the process has already, which it inherited: Linux counts them as its own.
std::size_t inherited() {
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  for (int field = 0; field < 6 && file; ++field) // the sixth: data and stack
    file >> pages;
  return file ? pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

void send(int pipe, const std::string &bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t sent = ::write(pipe, bytes.data() + at, bytes.size() - at);
    if (sent <= 0 && errno != EINTR)
      return;
    at += sent > 0 ? static_cast<std::size_t>(sent) : 0;
  }
}

/// All that the child does: it never returns.
[[noreturn]] void work(int pipe, const std::filesystem::path &path, bool drops_root,
                       const ChildLimits &limits) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGINT, SIGTERM, SIGPIPE})
    std::signal(signal, SIG_DFL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.seconds);
  limit(RLIMIT_DATA, inherited() + limits.memory);
  if (const int nowhere = ::open("/dev/null", O_WRONLY); nowhere >= 0) {
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
  }
  std::string answer;
  try {
    Assimp::Importer importer;
    const aiScene *scene = importer.ReadFile(path.string(), 0);
    if (scene == nullptr)
      answer = is_refusal + clean_name(importer.GetErrorString());
    else
      answer = is_scene + pack_scene(*scene, drops_root);
  } catch (const std::exception &problem) {
    answer = is_refusal + clean_name(problem.what());
  }
  send(pipe, answer);
  ::_exit(0);
}

/// What the child sends until it ends, is silent for too long or sends too much, or nobody wants it
/// any more.
std::string receive(int pipe, const ChildLimits &limits, const std::atomic<bool> *cancel,
                    bool &is_late) {
  constexpr long look_ms = 50;
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::seconds(limits.seconds);
  std::string out;
  std::array<char, 65536> part{};
  while (!is_stopped(cancel)) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    struct pollfd wait {
      pipe, POLLIN, 0
    };
    const int ready =
        ::poll(&wait, 1, static_cast<int>(std::clamp<long>(left.count(), 0, look_ms)));
    if ((ready < 0 && errno == EINTR) || (ready == 0 && left.count() > 0))
      continue;
    is_late = ready <= 0;
    if (is_late || out.size() > limits.answer)
      return out;
    const ssize_t count = ::read(pipe, part.data(), part.size());
    if (count < 0 && errno == EINTR)
      continue;
    if (count <= 0)
      return out;
    out.append(part.data(), static_cast<std::size_t>(count));
  }
  return out;
}

} // namespace

Result<std::string> import_in_child(const std::filesystem::path &path, bool drops_root,
                                    const ChildLimits &limits, const std::atomic<bool> *cancel) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    return fail(ErrorCode::Device, "no pipe can be made to read the file through", {path.string()});
  const pid_t child = ::fork();
  if (child == 0)
    work(ends[1], path, drops_root, limits);
  ::close(ends[1]);
  bool is_late = false;
  std::string answer = child > 0 ? receive(ends[0], limits, cancel, is_late) : std::string();
  ::close(ends[0]);
  if (child < 0)
    return fail(ErrorCode::Device, "no process can be made to read the file in", {path.string()});
  if (is_late || is_stopped(cancel) || answer.size() > limits.answer)
    ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  leave_if_stopped(cancel);
  const char *remedy = "Export it again, best as glTF (.glb).";
  if (is_late || answer.empty() || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    return fail(
        ErrorCode::BadInput,
        fmt::format("the reader for this format {}; the file is damaged or too large. {}",
                    is_late ? fmt::format("was not done after {} s", limits.seconds) : "broke down",
                    remedy),
        {path.string()});
  if (answer[0] == is_refusal)
    return fail(ErrorCode::BadInput,
                fmt::format("the file cannot be read ({}). {}", answer.substr(1), remedy),
                {path.string()});
  answer.erase(0, 1);
  return answer;
}

} // namespace umov::mesh_io
