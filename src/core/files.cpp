#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <sys/stat.h>
#include <umov/core/files.h>
#include <unistd.h>

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

/// Closes and removes the temporary file unless it was committed.
struct TemporaryFile {
  fs::path path;
  int descriptor = -1;
  bool committed = false;
  ~TemporaryFile() {
    if (descriptor >= 0)
      ::close(descriptor);
    if (!committed)
      ::unlink(path.c_str());
  }
};

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

Result<void> write_file_atomically(const fs::path &path, std::string_view bytes) {
  if (std::error_code code; fs::is_directory(path, code))
    return fail(ErrorCode::Device, "this is a folder; the name of a file was expected",
                {path.string()});
  TemporaryFile temporary{path.string() + ".part-" + std::to_string(::getpid())};
  temporary.descriptor =
      ::open(temporary.path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (temporary.descriptor < 0)
    return device_error(path, "write here");
  while (!bytes.empty()) {
    const ssize_t written = ::write(temporary.descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR)
      continue;
    if (written < 0)
      return device_error(path, "write");
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fsync(temporary.descriptor) != 0 || ::rename(temporary.path.c_str(), path.c_str()) != 0)
    return device_error(path, "finish the file");
  temporary.committed = true;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  // A rename is durable only once the folder itself is on disk; some file systems refuse: harmless.
  if (const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); fd >= 0) {
    ::fsync(fd);
    ::close(fd);
  }
  return {};
}

} // namespace umov
