#pragma once
// Reading whole inputs and writing whole outputs: never half a file.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <umov/core/result.h>

namespace umov {

/// A path without "." and "..", where it names the same file without them: behind a link ".." is
/// the folder that the link points into. As it is where there is no such file with them.
std::filesystem::path tidy_path(const std::filesystem::path &path);

/// Whether something stands at a path; false also where that cannot be told.
[[nodiscard]] bool file_exists(const std::filesystem::path &path);

/// Contents of a file; a missing one, a folder or one larger than `limit_bytes` is BadInput and is
/// refused before anything is read. Device where reading breaks off before the end.
Result<std::string> read_file(const std::filesystem::path &path,
                              std::size_t limit_bytes = 256u << 20);

/// Writes through a temporary file in the same folder, fsync, rename and fsync of the folder: the
/// target is always absent, the complete old or the complete new file. Links are followed, and a
/// file that is replaced keeps its permissions. What is no regular file (a pipe, /dev/stdout) is
/// written to as it stands. Failure is Device.
Result<void> write_file_atomically(const std::filesystem::path &path, std::string_view bytes);

/// A file that grows piece by piece and is there under its name only when it is complete: written
/// as a temporary file in the same folder, which is removed unless `commit` succeeds; what a killed
/// process left goes when the same file is written again.
class FileInProgress {
public:
  /// Device if a file cannot be made there.
  static Result<FileInProgress> open(const std::filesystem::path &path);
  FileInProgress(FileInProgress &&other) noexcept;
  FileInProgress &operator=(FileInProgress &&other) noexcept;
  ~FileInProgress();

  /// Appends bytes. Device if they cannot be written.
  Result<void> write(std::string_view bytes);
  /// For a library that makes and fills the file by its name: where it goes. No `write` then.
  /// Device where a pipe or a device stands.
  static Result<FileInProgress> for_library(const std::filesystem::path &path);
  /// The library has made the file: it is in use from now on, and not what a kill left.
  void hold();
  /// Name of the file while it grows.
  [[nodiscard]] const std::filesystem::path &temporary() const { return temporary_; }
  /// Where it will stand, behind all links.
  [[nodiscard]] const std::filesystem::path &path() const { return path_; }
  /// Flushes to disk and renames to `path`, or to another name in the same folder.
  Result<void> commit();
  /// As `commit`, under another name in the same folder.
  Result<void> commit_as(const std::filesystem::path &path);

private:
  FileInProgress() = default;
  void discard();
  std::filesystem::path path_, temporary_;
  int descriptor_ = -1;
  bool is_direct_ = false; ///< no temporary file: a pipe, a device
};

} // namespace umov
