#pragma once
// Reading whole inputs and writing whole outputs: never half a file.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <umov/core/result.h>

namespace umov {

/// Contents of a file; a missing one, a folder or one larger than `limit_bytes` is BadInput and is
/// refused before anything is read.
Result<std::string> read_file(const std::filesystem::path &path,
                              std::size_t limit_bytes = 256u << 20);

/// Writes through a temporary file in the same folder, fsync, rename and fsync of the folder: the
/// target is always absent, the complete old or the complete new file. Failure is Device.
Result<void> write_file_atomically(const std::filesystem::path &path, std::string_view bytes);

} // namespace umov
