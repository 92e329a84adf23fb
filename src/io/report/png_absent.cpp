// In the place of png.cpp and animation.cpp where umov is built without libpng and zlib.
#include <umov/io/png.h>

namespace umov {
namespace {

tl::unexpected<Error> absent() {
  return fail(ErrorCode::Device,
              "this build has no PNG pictures and no report: leave html out of the formats, or "
              "build with -DUMOV_WITH_REPORT=ON");
}

} // namespace

Result<std::string> encode_png(std::uint32_t /*width*/, std::uint32_t /*height*/,
                               std::span<const std::uint8_t> /*rgb*/) {
  return absent();
}

Result<std::string> encode_animation(std::uint32_t /*width*/, std::uint32_t /*height*/,
                                     std::span<const std::vector<std::uint8_t>> /*frames*/,
                                     double /*frames_per_s*/) {
  return absent();
}

} // namespace umov
