#include "core/output_place.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <sys/stat.h>
#include <umov/core/files.h>
#include <umov/core/temporary.h>
#include <unistd.h>
#include <utility>

namespace umov {
namespace {

namespace fs = std::filesystem;

const char *remedy(int cause) {
  switch (cause) {
  case ENOENT:
  case ENOTDIR:
    return "Make the folder first or choose another one";
  case ENOSPC:
  case EDQUOT:
    return "Free some space or choose another folder";
  case EACCES:
  case EPERM:
  case EROFS:
    return "Change its permissions or choose another folder";
  default:
    return "Choose another folder";
  }
}

tl::unexpected<Error> device_error(const fs::path &path, const std::string &action) {
  const int cause = errno;
  return fail(ErrorCode::Device,
              "cannot " + action + ": " + std::strerror(cause) + ". " + remedy(cause) + ".",
              {path.string()});
}

/// A file that is replaced keeps who may read it, and whose it is as far as we may say so.
void keep_access(const fs::path &path, int descriptor) {
  struct stat old {};
  if (::stat(path.c_str(), &old) != 0 || !S_ISREG(old.st_mode))
    return;
  [[maybe_unused]] const int owner = ::fchown(descriptor, old.st_uid, old.st_gid);
  [[maybe_unused]] const int mode = ::fchmod(descriptor, old.st_mode & 0777);
}

void remove_abandoned(const fs::path &path) {
  std::error_code unknown; // somebody else's may stay
  for (const fs::path &old : abandoned_temporaries(path))
    if (!fs::is_directory(old, unknown))
      fs::remove(old, unknown);
}

} // namespace

bool file_exists(const fs::path &path) {
  std::error_code unknown;
  return fs::exists(path, unknown);
}

std::filesystem::path tidy_path(const std::filesystem::path &path) {
  std::error_code code;
  auto tidy = path.lexically_normal();
  const bool is_there = std::filesystem::exists(path, code) && !code;
  return is_there && !std::filesystem::equivalent(path, tidy, code) ? path : tidy;
}

Result<std::string> read_file(const fs::path &path, std::size_t limit_bytes) {
  std::error_code code;
  const auto status = fs::status(path, code);
  if (!fs::exists(status))
    return fail(ErrorCode::BadInput, "no such file; check the spelling of the path",
                {path.string()});
  if (fs::is_directory(status))
    return fail(ErrorCode::BadInput, "this is a folder; a file was expected", {path.string()});
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    return fail(ErrorCode::BadInput,
                std::string("cannot be opened: ") + std::strerror(errno) +
                    "; check its permissions",
                {path.string()});
  std::string bytes;
  std::string block(1u << 16, '\0');
  while (stream) { // by blocks, since a pipe has no size to ask for
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    if (bytes.size() + static_cast<std::size_t>(stream.gcount()) > limit_bytes)
      return fail(ErrorCode::BadInput,
                  "larger than the limit of " + std::to_string(limit_bytes >> 20) +
                      " MiB for one input; split it, or leave out what is not needed",
                  {path.string()});
    bytes.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) // not the end: what was read so far would look like a shorter file
    return fail(ErrorCode::Device,
                std::string("cannot be read to its end: ") + std::strerror(errno) + ", after " +
                    std::to_string(bytes.size()) + " bytes. Check the disk, or copy the file anew.",
                {path.string()});
  return bytes;
}

Result<FileInProgress> FileInProgress::open(const fs::path &path) {
  UMOV_ASSIGN(place, output_place(path));
  FileInProgress out;
  out.path_ = place.path;
  if (place.kind != OutputPlace::Kind::File) {
    out.is_direct_ = true;
    out.descriptor_ = place.kind == OutputPlace::Kind::Descriptor
                          ? ::fcntl(place.descriptor, F_DUPFD_CLOEXEC, 0)
                          : ::open(place.path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (out.descriptor_ < 0)
      return device_error(path, "write here");
    return out;
  }
  remove_abandoned(place.path);
  struct stat old {};
  const mode_t mode = ::stat(place.path.c_str(), &old) == 0 ? 0600 : 0644;
  // Not mkostemp, whose 0600 knows nothing of the umask; a name that is taken is never opened.
  for (int attempt = 0; attempt < 100 && out.descriptor_ < 0; ++attempt) {
    out.temporary_ = temporary_name(place.path);
    out.descriptor_ =
        ::open(out.temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
    if (out.descriptor_ < 0 && errno != EEXIST)
      break;
  }
  if (out.descriptor_ < 0) {
    out.temporary_.clear(); // nothing of ours to remove
    return device_error(path, "write here");
  }
  hold_temporary(out.descriptor_);
  return out;
}

Result<FileInProgress> FileInProgress::for_library(const fs::path &path) {
  UMOV_ASSIGN(place, output_place(path));
  if (place.kind != OutputPlace::Kind::File)
    return fail(ErrorCode::Device,
                "is no regular file, which this format needs. Choose the name of a file.",
                {path.string()});
  remove_abandoned(place.path);
  FileInProgress out;
  out.path_ = place.path;
  out.temporary_ = temporary_name(place.path);
  return out;
}

void FileInProgress::hold() {
  descriptor_ = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor_ >= 0)
    hold_temporary(descriptor_);
}

FileInProgress::FileInProgress(FileInProgress &&other) noexcept { *this = std::move(other); }
FileInProgress &FileInProgress::operator=(FileInProgress &&other) noexcept {
  if (this != &other) {
    discard();
    path_ = std::move(other.path_);
    temporary_ = std::exchange(other.temporary_, {});
    descriptor_ = std::exchange(other.descriptor_, -1);
    is_direct_ = other.is_direct_;
  }
  return *this;
}
FileInProgress::~FileInProgress() { discard(); }

void FileInProgress::discard() {
  if (descriptor_ >= 0)
    ::close(descriptor_);
  if (!temporary_.empty())
    ::unlink(temporary_.c_str());
  descriptor_ = -1;
  temporary_.clear();
}

Result<void> FileInProgress::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR)
      continue;
    if (written < 0)
      return device_error(path_, "write");
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

Result<void> FileInProgress::commit() { return commit_as(path_); }

Result<void> FileInProgress::commit_as(const fs::path &path) {
  if (is_direct_) { // pipes and most devices cannot be flushed to disk: harmless
    const bool is_lost = ::fsync(descriptor_) != 0 && (errno == EIO || errno == ENOSPC);
    const int closed = ::close(std::exchange(descriptor_, -1));
    return is_lost || closed != 0 ? Result<void>(device_error(path, "write")) : Result<void>();
  }
  if (descriptor_ < 0)
    descriptor_ = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor_ < 0)
    return device_error(path, "finish the file");
  keep_access(path, descriptor_);
  if (::fsync(descriptor_) != 0 || ::rename(temporary_.c_str(), path.c_str()) != 0)
    return device_error(path, "finish the file");
  ::close(std::exchange(descriptor_, -1));
  temporary_.clear();
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  // A rename is durable only once the folder itself is on disk; some file systems refuse: harmless.
  if (const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); fd >= 0) {
    ::fsync(fd);
    ::close(fd);
  }
  return {};
}

Result<void> write_file_atomically(const fs::path &path, std::string_view bytes) {
  UMOV_ASSIGN(file, FileInProgress::open(path));
  UMOV_TRY(file.write(bytes));
  return file.commit();
}

} // namespace umov
