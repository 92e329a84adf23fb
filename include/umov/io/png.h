#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <umov/core/result.h>

namespace umov {

/// An 8-bit sRGB picture as the bytes of a PNG file. `rgb`: 3 width height values, rows from the
/// top. No time or text chunk: the same picture gives the same bytes. Internal if the sizes do not
/// agree.
Result<std::string> encode_png(std::uint32_t width, std::uint32_t height,
                               std::span<const std::uint8_t> rgb);

} // namespace umov
