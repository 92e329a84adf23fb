#include <gtest/gtest.h>
#include <png.h>
#include <umov/io/png.h>
#include <vector>

namespace umov {
namespace {

std::vector<std::uint8_t> ramp(std::uint32_t width, std::uint32_t height) {
  std::vector<std::uint8_t> rgb(std::size_t{3} * width * height);
  for (std::size_t i = 0; i < rgb.size(); ++i)
    rgb[i] = static_cast<std::uint8_t>(i * 37 % 251);
  return rgb;
}

TEST(Png, ReadsBackToTheSamePixels) { // reader: libpng
  const auto rgb = ramp(7, 5);
  const auto bytes = encode_png(7, 5, rgb);
  ASSERT_TRUE(bytes) << bytes.error().text();
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes->data(), bytes->size()), 0);
  EXPECT_EQ(image.width, 7U);
  EXPECT_EQ(image.height, 5U);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> back(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, back.data(), 0, nullptr), 0);
  EXPECT_EQ(back, rgb);
}

TEST(Png, HasSignatureAndNoTimeOrText) { // signature: PNG specification (W3C 2003), 5.2
  const auto bytes = encode_png(16, 16, ramp(16, 16));
  ASSERT_TRUE(bytes);
  EXPECT_EQ(bytes->substr(0, 8), "\x89PNG\r\n\x1a\n");
  for (const char *chunk : {"tIME", "tEXt", "zTXt", "iTXt"})
    EXPECT_EQ(bytes->find(chunk), std::string::npos) << chunk;
  EXPECT_EQ(*bytes, *encode_png(16, 16, ramp(16, 16)));
}

TEST(Png, RefusesAPictureWhoseSizesDoNotAgree) {
  const auto result = encode_png(4, 4, ramp(4, 3));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::Internal);
  EXPECT_NE(result.error().message.find("has 36 bytes, expected 48"), std::string::npos);
  EXPECT_FALSE(encode_png(0, 4, {}));
}

} // namespace
} // namespace umov
