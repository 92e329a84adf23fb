#pragma once
// A file as bytes in memory.

#include <filesystem>
#include <string_view>
#include <umov/core/result.h>

namespace umov {

/// Fetched page by page as it is read. Nobody may shorten the file meanwhile.
class MappedFile {
public:
  /// BadInput for what is not there, no file (a folder, a pipe) or not to be read.
  static Result<MappedFile> open(const std::filesystem::path &path);
  MappedFile() = default;
  MappedFile(MappedFile &&other) noexcept;
  MappedFile &operator=(MappedFile &&other) noexcept;
  MappedFile(const MappedFile &) = delete;
  MappedFile &operator=(const MappedFile &) = delete;
  ~MappedFile();
  /// All of it, as long as this lives; they begin at a page.
  [[nodiscard]] std::string_view bytes() const { return {data_, size_}; }

private:
  const char *data_ = nullptr;
  std::size_t size_ = 0;
};

} // namespace umov
