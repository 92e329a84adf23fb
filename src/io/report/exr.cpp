#include <umov/io/exr.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <algorithm>
#include <exception>
#include <fmt/format.h>
#include <new>

namespace umov {
namespace {

/// OpenEXR writes its table of offsets last, at the beginning: it needs to seek.
class MemoryStream : public Imf::OStream {
public:
  MemoryStream() : Imf::OStream("memory") {}
  void write(const char bytes[], int count) override {
    const std::size_t end = place_ + static_cast<std::size_t>(count);
    if (end > text.size())
      text.resize(end);
    std::copy(bytes, bytes + count, text.begin() + static_cast<std::ptrdiff_t>(place_));
    place_ = end;
  }
  std::uint64_t tellp() override { return place_; }
  void seekp(std::uint64_t place) override { place_ = place; }

  std::string text;

private:
  std::uint64_t place_ = 0;
};

} // namespace

Result<std::string> encode_exr(std::uint32_t width, std::uint32_t height,
                               std::span<const PictureChannel> channels,
                               std::span<const std::pair<std::string, std::string>> notes) {
  const std::size_t pixels = std::size_t{width} * height;
  for (const PictureChannel &channel : channels)
    if (pixels == 0 || channel.values.size() != pixels)
      return fail(ErrorCode::Internal,
                  fmt::format("channel {} has {} values, expected {} x {}", channel.name,
                              channel.values.size(), width, height));
  try {
    Imf::Header header(static_cast<int>(width), static_cast<int>(height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto &[key, value] : notes)
      header.insert(key.c_str(), Imf::StringAttribute(value));
    Imf::FrameBuffer buffer;
    for (const PictureChannel &channel : channels) {
      header.channels().insert(channel.name.c_str(), Imf::Channel(Imf::FLOAT));
      // OpenEXR reads through a pointer that is not to const.
      auto *first = const_cast<char *>(reinterpret_cast<const char *>(channel.values.data()));
      buffer.insert(channel.name.c_str(),
                    Imf::Slice(Imf::FLOAT, first, sizeof(float), sizeof(float) * width));
    }
    MemoryStream stream;
    {
      Imf::OutputFile file(stream, header);
      file.setFrameBuffer(buffer);
      file.writePixels(static_cast<int>(height));
    }
    return std::move(stream.text);
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &problem) {
    return fail(ErrorCode::Internal,
                std::string("OpenEXR cannot write a picture: ") + problem.what());
  }
}

} // namespace umov
