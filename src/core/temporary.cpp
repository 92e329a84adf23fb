#include <umov/core/temporary.h>

#include "core/output_place.h"

#include <array>
#include <atomic>
#include <charconv>
#include <ctime>
#include <fcntl.h>
#include <random>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace umov {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view mark = ".part-";
constexpr std::size_t tail_bytes = 40; // more than mark, PID and random number need

/// The part of a temporary name that all of an output share.
std::string stem(const fs::path &output, const std::string &before) {
  const std::string room(tail_bytes, ' ');
  std::string out = beside(output, before, room).filename().string();
  out.resize(out.size() - tail_bytes);
  return out + std::string(mark);
}

/// "1234-5f03ab1".
bool is_tail(std::string_view text) {
  const std::size_t dash = text.find('-');
  return dash != std::string_view::npos && dash > 0 && dash + 1 < text.size() &&
         text.substr(0, dash).find_first_not_of("0123456789") == std::string_view::npos &&
         text.substr(dash + 1).find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// Nobody holds it, and it is not just being made.
bool is_abandoned(const fs::path &path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0)
    return false;
  constexpr time_t young_s = 60;
  struct stat status {};
  const bool out =
      ::fstat(descriptor, &status) == 0 && (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)) &&
      ::time(nullptr) - status.st_mtime > young_s && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  ::close(descriptor);
  return out;
}

/// Not by a stream, which leaves out what it has no memory for.
std::string hex(unsigned value) {
  std::array<char, 2 * sizeof value> out{};
  return {out.data(), std::to_chars(out.data(), out.data() + out.size(), value, 16).ptr};
}

} // namespace

fs::path temporary_name(const fs::path &output, const std::string &before) {
  static std::atomic<unsigned> count{0};
  std::random_device random;
  return output.parent_path() /
         (stem(output, before) + std::to_string(::getpid()) + '-' + hex(random()) + hex(++count));
}

void hold_temporary(int descriptor) {
  // Where locks are not to be had nobody gets one, and nothing is ever taken for abandoned.
  [[maybe_unused]] const int held = ::flock(descriptor, LOCK_EX | LOCK_NB);
}

std::vector<fs::path> abandoned_temporaries(const fs::path &output, const std::string &before) {
  std::vector<fs::path> out;
  const std::string begin = stem(output, before);
  const fs::path folder = output.has_parent_path() ? output.parent_path() : fs::path(".");
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with(begin) && is_tail(std::string_view(name).substr(begin.size())) &&
        is_abandoned(at->path()))
      out.push_back(at->path());
  }
  return out;
}

} // namespace umov
