#include "core/output_place.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

namespace umov {
namespace {

namespace fs = std::filesystem;

/// N of /dev/fd/N and its like in this process, else -1. What is open is not to be replaced: a
/// shell that appends to a file (`>> all.txt`) keeps its lines.
int own_descriptor(const fs::path &path) {
  const std::string name = path.filename().string();
  int out = -1;
  const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), out);
  if (code != std::errc() || end != name.data() + name.size() || out < 0)
    return -1;
  std::error_code unknown, no_proc;
  const fs::path folder = fs::canonical(path.parent_path(), unknown),
                 ours = fs::canonical("/proc/self/fd", no_proc);
  return !unknown && !no_proc && folder == ours ? out : -1;
}

/// The rule of Linux (fs.protected_symlinks), which holds where a link is opened but not where it
/// is read: in a folder like /tmp only links of one's own or of the folder's owner are followed.
bool may_follow(const fs::path &path, const struct stat &link) {
  struct stat folder {};
  const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (::stat(parent.c_str(), &folder) != 0)
    return false;
  const bool is_everybodys = (folder.st_mode & S_ISVTX) != 0 && (folder.st_mode & S_IWOTH) != 0;
  return !is_everybodys || link.st_uid == ::geteuid() || link.st_uid == folder.st_uid;
}

} // namespace

Result<OutputPlace> output_place(const fs::path &path) {
  using Kind = OutputPlace::Kind;
  const auto refuse = [&](const std::string &text) {
    return fail(ErrorCode::Device, text, {path.string()});
  };
  constexpr int most_links = 40; // as Linux has it
  fs::path at = path;
  for (int hop = 0; hop < most_links; ++hop) {
    if (const int open = own_descriptor(at); open >= 0)
      return OutputPlace{Kind::Descriptor, at, open};
    struct stat one {};
    if (::lstat(at.c_str(), &one) != 0)
      return OutputPlace{Kind::File, at, -1}; // not there yet; trouble shows when it is made
    const bool is_link = S_ISLNK(one.st_mode);
    if (is_link && !may_follow(at, one))
      return refuse("is a link that somebody else put into a folder of everybody's; it is not "
                    "followed. Choose another name.");
    struct stat end {};
    if (::stat(at.c_str(), &end) == 0) {
      if (S_ISDIR(end.st_mode))
        return refuse("this is a folder; the name of a file was expected");
      if (!S_ISREG(end.st_mode))
        return OutputPlace{Kind::Stream, at, -1};
    }
    if (!is_link)
      return OutputPlace{Kind::File, at, -1};
    std::error_code code;
    const fs::path target = fs::read_symlink(at, code);
    if (code)
      return refuse("is a link that cannot be read: " + code.message());
    at = target.is_absolute() ? target : at.parent_path() / target;
  }
  return refuse("is a link that leads in a circle. Choose another name.");
}

fs::path beside(const fs::path &path, const std::string &before, const std::string &after) {
  constexpr std::size_t most = 255; // NAME_MAX of every file system in use
  const std::string name = path.filename().string();
  const std::size_t room = most - std::min(most, before.size() + after.size());
  return path.parent_path() / (before + name.substr(0, room) + after);
}

} // namespace umov
