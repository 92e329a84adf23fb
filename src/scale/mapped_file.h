#pragma once
// Private: a file as bytes in memory.

#include <filesystem>
#include <string_view>
#include <umov/core/result.h>

namespace umov::scale {

/// Fetched page by page as it is read.
class MappedFile {
public:
  /// BadInput if it is not there or not to be read.
  static Result<MappedFile> open(const std::filesystem::path &path);
  MappedFile() = default;
  MappedFile(MappedFile &&other) noexcept;
  MappedFile &operator=(MappedFile &&other) noexcept;
  MappedFile(const MappedFile &) = delete;
  MappedFile &operator=(const MappedFile &) = delete;
  ~MappedFile();
  [[nodiscard]] std::string_view bytes() const { return {data_, size_}; }

private:
  const char *data_ = nullptr;
  std::size_t size_ = 0;
};

} // namespace umov::scale
