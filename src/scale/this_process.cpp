#include "scale/this_process.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sys/resource.h>
#include <unistd.h>

namespace umov::scale {
namespace {

namespace fs = std::filesystem;

/// The least number in files of that name, from a control group up to its root; "max" is none.
std::size_t least_of(const fs::path &root, fs::path group, const char *file) {
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (group = group.relative_path();; group = group.parent_path()) {
    if (std::size_t bytes = 0; std::ifstream(root / group / file) >> bytes)
      least = std::min(least, bytes);
    if (group.empty())
      return least;
  }
}

/// Bytes that the control groups of this process allow, by cgroups(7): version 2 in a line of
/// number 0, version 1 in that of the controller "memory".
std::size_t allowed_bytes() {
  std::size_t least = std::numeric_limits<std::size_t>::max();
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);)
    if (line.starts_with("0::"))
      least = std::min(least, least_of("/sys/fs/cgroup", line.substr(3), "memory.max"));
    else if (const std::size_t name = line.find(":memory:"); name != std::string::npos)
      least = std::min(
          least, least_of("/sys/fs/cgroup/memory", line.substr(name + 8), "memory.limit_in_bytes"));
  return least;
}

} // namespace

std::string this_host() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

double cpu_seconds() {
  struct rusage used {};
  ::getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval &t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

std::size_t memory_here_mb() {
  const auto pages = static_cast<std::size_t>(::sysconf(_SC_PHYS_PAGES));
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  return std::min(pages * page, allowed_bytes()) / 10 * 9 / 1'000'000;
}

} // namespace umov::scale
