#include <umov/io/png.h>

#include <fmt/format.h>
#include <png.h>

namespace umov {

Result<std::string> encode_png(std::uint32_t width, std::uint32_t height,
                               std::span<const std::uint8_t> rgb) {
  if (width == 0 || height == 0 || rgb.size() != std::size_t{3} * width * height)
    return fail(ErrorCode::Internal,
                fmt::format("picture of {} x {} has {} bytes, expected {}", width, height,
                            rgb.size(), std::size_t{3} * width * height));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  // The most that it can need: to be told exactly would be to compress twice.
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string out(size, '\0');
  if (png_image_write_to_memory(&image, out.data(), &size, 0, rgb.data(), 0, nullptr) != 0) {
    out.resize(size);
    return out;
  }
  const std::string reason = image.message;
  png_image_free(&image);
  return fail(ErrorCode::Internal, "libpng cannot write a picture: " + reason);
}

} // namespace umov
