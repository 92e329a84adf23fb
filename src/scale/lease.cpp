#include <umov/scale/lease.h>

#include "scale/this_process.h"

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <mutex>
#include <sys/stat.h>
#include <thread>
#include <umov/core/files.h>
#include <unistd.h>
#include <vector>

namespace umov::scale {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds renewed_each{30};
/// One that was not renewed for so long is nobody's.
constexpr double stale_s = 120;

/// "HOST PID" of a lease that holds, else "".
std::string holder_of(const fs::path &file) {
  struct stat about {};
  if (::stat(file.c_str(), &about) != 0 ||
      std::difftime(std::time(nullptr), about.st_mtime) > stale_s)
    return "";
  const auto text = read_file(file, 4096);
  if (!text)
    return "";
  const std::size_t blank = text->find(' ');
  if (blank != std::string::npos && text->substr(0, blank) == this_host()) {
    const int pid = std::atoi(text->c_str() + blank + 1);
    if (pid > 0 && ::kill(pid, 0) != 0 && errno == ESRCH)
      return ""; // its process was killed
  }
  return *text;
}

struct Held {
  fs::path file;
  std::string holder;
};

std::vector<Held> held_in(const fs::path &folder) {
  std::vector<Held> out;
  std::error_code unknown;
  for (const auto &entry : fs::directory_iterator(folder, unknown))
    if (entry.path().filename().string().starts_with("lease"))
      if (std::string holder = holder_of(entry.path()); !holder.empty())
        out.push_back({entry.path(), std::move(holder)});
  return out;
}

/// Made by us alone; false if it is there.
bool make(const fs::path &file) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (descriptor < 0)
    return false;
  const std::string text = fmt::format("{} {}", this_host(), ::getpid());
  [[maybe_unused]] const ssize_t written = ::write(descriptor, text.data(), text.size());
  ::close(descriptor);
  return true;
}

} // namespace

struct Lease::State {
  fs::path file;
  std::mutex mutex;
  std::condition_variable ended;
  bool is_over = false;
  std::thread renewing;

  static std::unique_ptr<State> of(const fs::path &file) {
    auto out = std::make_unique<State>();
    out->file = file;
    out->renewing = std::thread([held = out.get()] { held->renew(); });
    return out;
  }
  void renew() {
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, renewed_each, [this] { return is_over; }))
      ::utimensat(AT_FDCWD, file.c_str(), nullptr, 0);
  }
  ~State() {
    {
      const std::scoped_lock lock(mutex);
      is_over = true;
    }
    ended.notify_all();
    if (renewing.joinable())
      renewing.join();
    std::error_code unknown;
    fs::remove(file, unknown);
  }
};

Lease::Lease(std::unique_ptr<State> state) : state_(std::move(state)) {}
Lease::Lease(Lease &&) noexcept = default;
Lease &Lease::operator=(Lease &&) noexcept = default;
Lease::~Lease() = default;

Result<Lease> Lease::take(const fs::path &folder, const std::string &part) {
  const fs::path file = folder / (part.empty() ? "lease" : "lease-" + part);
  const fs::path whole = folder / "lease";
  const auto busy = [&folder](const std::string &who) {
    return fail(ErrorCode::Device,
                fmt::format("another umov is at work here ({}). Wait for it, or take part in its "
                            "work with --join.",
                            who),
                {folder.string()});
  };
  for (const Held &held : held_in(folder))
    if (part.empty() || held.file == whole || held.file == file)
      return busy(held.holder);
  std::error_code unknown;
  fs::remove(file, unknown); // of a process that was killed
  if (!make(file))
    return busy(holder_of(file));
  return Lease(State::of(file));
}

Result<Lease> Lease::join(const fs::path &folder) {
  const fs::path file = folder / fmt::format("lease-with-{}-{}", this_host(), ::getpid());
  std::error_code unknown;
  fs::remove(file, unknown); // of a process that had our number
  if (!make(file))
    return fail(ErrorCode::Device, fmt::format("cannot be made: {}", ::strerror(errno)),
                {file.string()});
  return Lease(State::of(file));
}

bool Lease::is_alone() const { return held_in(state_->file.parent_path()).size() <= 1; }

std::string lease_holders(const fs::path &folder) {
  std::string out;
  for (const Held &held : held_in(folder))
    out += (out.empty() ? "" : ", ") + held.holder;
  return out;
}

} // namespace umov::scale
