#pragma once
// Whether what `umov signature` writes will find its place.

#include "console.h"

#include <cstddef>
#include <string>

namespace umov::cli {

/// Before minutes are spent on masks that could not be kept.
Result<void> check_mask_file(const std::string &file);
/// Says how large a table will be before it is made, and refuses one for which there is no room.
Result<void> tell_size(const std::string &path, std::size_t rows, const Common &common);

} // namespace umov::cli
