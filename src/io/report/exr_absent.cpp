// In the place of exr.cpp where umov is built without OpenEXR.
#include <umov/io/exr.h>

namespace umov {

Result<std::string> encode_exr(std::uint32_t /*width*/, std::uint32_t /*height*/,
                               std::span<const PictureChannel> /*channels*/,
                               std::span<const std::pair<std::string, std::string>> /*notes*/) {
  return fail(ErrorCode::Device,
              "this build has no OpenEXR: write .png, or build with -DUMOV_WITH_EXR=ON");
}

} // namespace umov
