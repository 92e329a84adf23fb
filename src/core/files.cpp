#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <sys/stat.h>
#include <umov/core/files.h>
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

} // namespace

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
                      " MiB for one input",
                  {path.string()});
    bytes.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  return bytes;
}

Result<FileInProgress> FileInProgress::open(const fs::path &path) {
  if (std::error_code code; fs::is_directory(path, code))
    return fail(ErrorCode::Device, "this is a folder; the name of a file was expected",
                {path.string()});
  FileInProgress out = for_library(path);
  out.descriptor_ = ::open(out.temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (out.descriptor_ < 0)
    return device_error(path, "write here");
  return out;
}

FileInProgress FileInProgress::for_library(const fs::path &path) {
  FileInProgress out;
  out.path_ = path;
  out.temporary_ = path.string() + ".part-" + std::to_string(::getpid());
  return out;
}

FileInProgress::FileInProgress(FileInProgress &&other) noexcept { *this = std::move(other); }
FileInProgress &FileInProgress::operator=(FileInProgress &&other) noexcept {
  if (this != &other) {
    discard();
    path_ = std::move(other.path_);
    temporary_ = std::exchange(other.temporary_, {});
    descriptor_ = std::exchange(other.descriptor_, -1);
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
  if (descriptor_ < 0)
    descriptor_ = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0 || ::fsync(descriptor_) != 0 ||
      ::rename(temporary_.c_str(), path.c_str()) != 0)
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
