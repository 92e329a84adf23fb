#pragma once
// Private: an OFF file held against its own header.

#include <atomic>
#include <string>
#include <string_view>
#include <umov/core/result.h>

namespace umov::mesh_io {

/// BadInput with the line for counts that the bytes cannot hold, lines that are missing or short,
/// and faces that name no vertex. Throws Failure (Interrupted) once `cancel`, which may be null,
/// became true.
Result<void> check_off(std::string_view bytes, const std::string &file,
                       const std::atomic<bool> *cancel);

} // namespace umov::mesh_io
