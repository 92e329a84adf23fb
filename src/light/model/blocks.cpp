#include <umov/light/blocks.h>

namespace umov {
namespace {

/// For each way in which a model may be lit. Rays take tenths of a second a pose, masks
/// microseconds.
struct BlockLengths {
  std::size_t rays, automatic, masks;
  [[nodiscard]] std::size_t of(LightMethod method) const {
    switch (method) {
    case LightMethod::Rays:
      return rays;
    case LightMethod::Auto:
      return automatic;
    case LightMethod::Masks:
      return masks;
    }
    return rays;
  }
};

constexpr BlockLengths series{32, 512, 16'384}, list{512, 4096, 131'072};
/// Paths are drawn for the poses of a block; chains for the body, which many poses then share.
constexpr std::size_t series_with_paths = 256, list_with_paths = 512, list_with_chains = 4096;

} // namespace

std::size_t series_block(const LightModel &light, const LightOptions &options) {
  return options.bounces > 1 ? series_with_paths : series.of(light.facts().method);
}

std::size_t list_block(const LightModel &light, const LightOptions &options) {
  if (options.bounces > 1)
    return options.between == BetweenMethod::Chains ? list_with_chains : list_with_paths;
  return list.of(light.facts().method);
}

} // namespace umov
