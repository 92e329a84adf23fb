#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <umov/core/result.h>
#include <umov/picture/channel.h>
#include <utility>
#include <vector>

namespace umov {

/// A picture as the bytes of an OpenEXR file (scan lines, ZIP). `notes`: attributes of text. The
/// same picture gives the same bytes. Internal if a channel has another size.
Result<std::string> encode_exr(std::uint32_t width, std::uint32_t height,
                               std::span<const PictureChannel> channels,
                               std::span<const std::pair<std::string, std::string>> notes);

} // namespace umov
