#include <umov/io/png.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <zlib.h>

namespace umov {
namespace {

constexpr std::size_t signature_bytes = 8;

std::string number(std::uint32_t value, int bytes = 4) {
  std::string out;
  for (int k = bytes - 1; k >= 0; --k)
    out += static_cast<char>(value >> (8 * k) & 0xFF);
  return out;
}

/// Length, type, data, checksum (PNG third edition, section 5.3).
std::string chunk(const std::string &type, const std::string &data) {
  const std::string checked = type + data;
  const auto crc =
      crc32(0, reinterpret_cast<const Bytef *>(checked.data()), static_cast<uInt>(checked.size()));
  return number(static_cast<std::uint32_t>(data.size())) + checked +
         number(static_cast<std::uint32_t>(crc));
}

/// Data of all chunks of a type.
std::vector<std::string> data_of(const std::string &png, const std::string &type) {
  std::vector<std::string> out;
  for (std::size_t at = signature_bytes; at + 12 <= png.size();) {
    std::uint32_t length = 0;
    for (std::size_t k = 0; k < 4; ++k)
      length = length << 8 | static_cast<unsigned char>(png[at + k]);
    if (png.compare(at + 4, 4, type) == 0)
      out.push_back(png.substr(at + 8, length));
    at += 12 + std::size_t{length};
  }
  return out;
}

} // namespace

Result<std::string> encode_animation(std::uint32_t width, std::uint32_t height,
                                     std::span<const std::vector<std::uint8_t>> frames,
                                     double frames_per_s) {
  if (frames.empty() || !(frames_per_s > 0))
    return fail(ErrorCode::Internal, "an animation needs frames and a rate");
  std::string out;
  std::uint32_t sequence = 0;
  const auto delay_ms =
      static_cast<std::uint32_t>(std::clamp(std::lround(1000 / frames_per_s), 1L, 65'535L));
  for (std::size_t f = 0; f < frames.size(); ++f) {
    UMOV_ASSIGN(png, encode_png(width, height, frames[f]));
    if (f == 0) {
      out = png.substr(0, signature_bytes);
      out += chunk("IHDR", data_of(png, "IHDR").at(0));
      for (const char *type : {"gAMA", "cHRM", "sRGB"})
        for (const std::string &data : data_of(png, type))
          out += chunk(type, data);
      out += chunk("acTL", number(static_cast<std::uint32_t>(frames.size())) + number(0));
    }
    // Whole picture, no offset, replaced as it is.
    out +=
        chunk("fcTL", number(sequence++) + number(width) + number(height) + number(0) + number(0) +
                          number(delay_ms, 2) + number(1000, 2) + number(0, 1) + number(0, 1));
    for (const std::string &data : data_of(png, "IDAT"))
      out += f == 0 ? chunk("IDAT", data) : chunk("fdAT", number(sequence++) + data);
  }
  return out + chunk("IEND", "");
}

} // namespace umov
