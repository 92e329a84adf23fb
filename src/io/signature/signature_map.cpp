// A file of a signature as memory.

#include <umov/io/signature_file.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace umov {

Result<SignatureFile> SignatureFile::open(const std::filesystem::path &path, bool checks_all) {
  const auto refuse = [&](const std::string &what) {
    return fail(ErrorCode::BadInput, what, {path.string()});
  };
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0)
    return refuse(std::string("cannot be opened: ") + std::strerror(errno));
  struct stat about {};
  const bool is_file = ::fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode);
  SignatureFile out;
  if (is_file && about.st_size > 0) {
    void *const bytes = ::mmap(nullptr, static_cast<std::size_t>(about.st_size), PROT_READ,
                               MAP_PRIVATE, descriptor, 0);
    if (bytes != MAP_FAILED) {
      out.bytes_ = bytes;
      out.size_ = static_cast<std::size_t>(about.st_size);
    }
  }
  ::close(descriptor);
  if (!is_file)
    return refuse("a file with a signature was expected");
  UMOV_ASSIGN(view, parse_signature({static_cast<const char *>(out.bytes_), out.size_},
                                    path.string(), checks_all));
  out.view_ = std::move(view);
  return out;
}

SignatureFile::SignatureFile(SignatureFile &&other) noexcept { *this = std::move(other); }

SignatureFile &SignatureFile::operator=(SignatureFile &&other) noexcept {
  std::swap(bytes_, other.bytes_);
  std::swap(size_, other.size_);
  std::swap(view_, other.view_);
  return *this;
}

SignatureFile::~SignatureFile() {
  if (bytes_ != nullptr)
    ::munmap(bytes_, size_);
}

} // namespace umov
