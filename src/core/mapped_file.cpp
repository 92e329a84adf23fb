#include <umov/core/mapped_file.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace umov {

Result<MappedFile> MappedFile::open(const std::filesystem::path &path) {
  const auto problem = [&path] {
    return fail(ErrorCode::BadInput, std::string("cannot be read: ") + std::strerror(errno),
                {path.string()});
  };
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0)
    return problem();
  struct stat about {};
  MappedFile out;
  if (::fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode) && about.st_size > 0) {
    const auto size = static_cast<std::size_t>(about.st_size);
    void *const at = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
    if (at != MAP_FAILED) {
      out.data_ = static_cast<const char *>(at);
      out.size_ = size;
    }
  }
  ::close(descriptor);
  if (!S_ISREG(about.st_mode))
    return fail(ErrorCode::BadInput, "is no file; a file was expected", {path.string()});
  if (out.data_ == nullptr && about.st_size > 0)
    return problem();
  return out;
}

MappedFile::MappedFile(MappedFile &&other) noexcept { *this = std::move(other); }
MappedFile &MappedFile::operator=(MappedFile &&other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}
MappedFile::~MappedFile() {
  if (data_ != nullptr)
    ::munmap(const_cast<char *>(data_), size_);
}

} // namespace umov
