#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// An 8-bit sRGB picture as the bytes of a PNG file. `rgb`: 3 width height values, rows from the
/// top. No time or text chunk: the same picture gives the same bytes. Internal if the sizes do not
/// agree.
Result<std::string> encode_png(std::uint32_t width, std::uint32_t height,
                               std::span<const std::uint8_t> rgb);

/// Pictures of one size in turn as one animated PNG (APNG 1.0, W3C PNG third edition), played for
/// ever; viewers without animation show the first. Internal if the sizes do not agree.
Result<std::string> encode_animation(std::uint32_t width, std::uint32_t height,
                                     std::span<const std::vector<std::uint8_t>> frames,
                                     double frames_per_s);

} // namespace umov
