#pragma once
// Private: an OFF file held against its own header.

#include <string>
#include <string_view>
#include <umov/core/result.h>

namespace umov::mesh_io {

/// BadInput with the line for counts that the bytes cannot hold, lines that are missing or short,
/// and faces that name no vertex.
Result<void> check_off(std::string_view bytes, const std::string &file);

} // namespace umov::mesh_io
